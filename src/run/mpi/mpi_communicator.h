// Ranks joined by MPI. Every call begins with a round of headers: each rank tells which call it
// makes and how long its message is, or that it has failed. So a failure reaches all others in
// whichever call they are, all leave by the same round, and MPI can be ended in order.
#pragma once

#include <mpi.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "kinetome/base/communicator.h"

namespace kinetome {

class MpiCommunicator final : public Communicator {
  public:
    /// Starts MPI. Throws UsageError when it cannot be used beside threads.
    explicit MpiCommunicator(size_t largest_message);
    ~MpiCommunicator() override;
    MpiCommunicator(const MpiCommunicator&) = delete;
    MpiCommunicator& operator=(const MpiCommunicator&) = delete;

    int rank() const override { return rank_; }
    int size() const override { return size_; }
    std::vector<std::string> gather_to_all(std::string bytes) override;
    std::vector<std::string> gather(std::string bytes) override;
    std::string broadcast(std::string bytes) override;
    std::string pass(int to, std::string bytes) override;
    std::vector<WorkList*> work_lists() override { return work_lists_; }
    void check() override;
    ExitCode fail(ExitCode code, const std::string& message) noexcept override;

  private:
    enum class Call : int64_t { gather_to_all, gather, broadcast, pass, check, leave, fail };
    /// What each rank tells at the beginning of a call.
    struct Header {
        Call call;
        int64_t length;  ///< bytes of its message
        int64_t code;    ///< exit code, when it has failed
        int64_t to;      ///< rank it passes its message to
    };
    using Headers = std::vector<Header>;

    /// The headers of all, in rank order.
    Headers exchange(Header mine) const;
    /// The same, when all make this call. Throws RankFailure, or std::logic_error when they do not.
    Headers begin(Call call, const std::string& bytes, int to = nobody);
    /// Learns of the lowest rank that failed, if one did; `mine`: the message of this one.
    void hear_of_failure(const Headers& headers, const std::string& mine);

    std::vector<std::string> gather_at_once(const Headers& headers, const std::string& bytes) const;
    std::vector<std::string> gather_in_turn(const Headers& headers, std::string bytes) const;
    /// Calls pass(first byte, count) for the parts of a message.
    template <class Pass>
    void in_parts(std::string& bytes, Pass pass) const;
    void broadcast_from(int rank, std::string& bytes) const;

    void share_work_lists();

    size_t largest_message_;
    int rank_ = 0;
    int size_ = 1;
    std::optional<RankFailure> failure_;
    MPI_Comm machine_ = MPI_COMM_NULL;  ///< the ranks on this machine
    MPI_Win shared_memory_ = MPI_WIN_NULL;
    std::vector<WorkList*> work_lists_;
};

}  // namespace kinetome
