// The processes that carry out a run together: one, or the ranks of an MPI job, by the same calls
// (design §6). Every rank makes the same calls in the same order, and each call is also where it
// learns that another rank has failed or was asked to stop.
#pragma once

#include <string>
#include <vector>

#include "kinetome/base/error.h"
#include "kinetome/base/work_list.h"

namespace kinetome {

/// Thrown by every call of a rank's communicator once another rank has failed. what() names it.
struct RankFailure : Error {
    using Error::Error;
};

/// Calls are made by one thread of each rank, outside parallel regions.
class Communicator {
  public:
    virtual ~Communicator() = default;

    virtual int rank() const = 0;
    virtual int size() const = 0;
    /// Rank 0 alone creates files that are one for the run, publishes and speaks.
    bool is_root() const { return rank() == 0; }

    /// What every rank brought, in rank order, at every rank.
    virtual std::vector<std::string> gather_to_all(std::string bytes) = 0;
    /// The same at rank 0; nothing at the others.
    virtual std::vector<std::string> gather(std::string bytes) = 0;
    /// What rank 0 brought, at every rank; what others brought is ignored.
    virtual std::string broadcast(std::string bytes) = 0;
    /// What another rank passed to this one, if any did: every rank passes bytes to one other, or
    /// to `nobody`, and at most one rank to each.
    virtual std::string pass(int to, std::string bytes) = 0;
    static constexpr int nobody = -1;
    /// Nobody goes on before all have come here.
    void wait_for_all() { gather_to_all({}); }

    /// One list a rank, in memory that the ranks of a machine share; null for ranks elsewhere.
    /// Empty when nothing is shared. A rank refills its own, and only between a call that all make
    /// and the next one.
    virtual std::vector<WorkList*> work_lists() { return {}; }

    /// Throws RankFailure when another rank has failed. Each rank may ask whenever it likes:
    /// between pieces of long work of its own, so that it does not go on for nothing.
    virtual void check() = 0;

    /// Tells the others that this rank ends: their call in progress, or their next one or check(),
    /// throws RankFailure with that code and message. This rank makes no further call, and waits
    /// until all have heard. When several fail at once, all hear of the lowest rank among them.
    /// Returns the code that was heard.
    virtual ExitCode fail(ExitCode code, const std::string& message) noexcept = 0;
};

/// One process alone.
class SerialCommunicator final : public Communicator {
  public:
    int rank() const override { return 0; }
    int size() const override { return 1; }
    std::vector<std::string> gather_to_all(std::string bytes) override {
        return {std::move(bytes)};
    }
    std::vector<std::string> gather(std::string bytes) override { return {std::move(bytes)}; }
    std::string broadcast(std::string bytes) override { return bytes; }
    std::string pass(int, std::string) override { return {}; }
    void check() override {}
    ExitCode fail(ExitCode code, const std::string&) noexcept override { return code; }
};

/// Who shares a piece of work: the threads of this process and, when `ranks` is set, the same
/// number of threads at each other rank.
struct Workers {
    Workers(int thread_count, Communicator* communicator = nullptr)
        : threads(thread_count), ranks(communicator) {}

    int threads;
    Communicator* ranks;

    int rank() const { return ranks ? ranks->rank() : 0; }
    int rank_count() const { return ranks ? ranks->size() : 1; }
    bool is_root() const { return rank() == 0; }
    /// This process without the others.
    Workers alone() const { return {threads}; }
};

}  // namespace kinetome
