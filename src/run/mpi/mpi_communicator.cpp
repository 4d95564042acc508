#include "mpi_communicator.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <limits>
#include <stdexcept>
#include <thread>
#include <type_traits>

namespace kinetome {
namespace {

constexpr int message_tag = 0;
constexpr int failure_tag = 1;  ///< of empty messages: the sender has failed

/// The slowest rank may be long in coming and need this processor: first yields it, then sleeps,
/// never more than an eighth of the time waited so far.
void wait_for(MPI_Request& request) {
    using namespace std::chrono_literals;
    using Clock = std::chrono::steady_clock;
    const auto began = Clock::now();
    for (;;) {
        int done = 0;
        MPI_Test(&request, &done, MPI_STATUS_IGNORE);
        if (done) return;
        const Clock::duration waited = Clock::now() - began;
        if (waited < 500us) {
            std::this_thread::yield();
        } else {
            std::this_thread::sleep_for(std::min<Clock::duration>(waited / 8, 1ms));
        }
    }
}

/// Ends all ranks at once, for when they cannot be told in order.
[[noreturn]] void abort_all_ranks(int rank, const char* reason) {
    std::fprintf(stderr, "kinetome: rank %d: %s\n", rank, reason);
    MPI_Abort(MPI_COMM_WORLD, static_cast<int>(ExitCode::internal));
    std::terminate();
}

/// Moves what the headers announced. The others count on it: an exception (no memory) cannot be
/// told to them any more.
template <class Move>
auto move_or_abort(int rank, Move move) {
    try {
        return move();
    } catch (const std::exception& error) {
        abort_all_ranks(rank, error.what());
    }
}

}  // namespace

MpiCommunicator::MpiCommunicator(size_t largest_message)
    : largest_message_(std::clamp<size_t>(largest_message, 1, std::numeric_limits<int>::max())) {
    int provided = MPI_THREAD_SINGLE;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    if (provided < MPI_THREAD_FUNNELED) {
        MPI_Finalize();
        throw UsageError("this MPI library forbids threads (MPI_THREAD_FUNNELED): use another one");
    }
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    share_work_lists();
}

void MpiCommunicator::share_work_lists() {
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &machine_);
    int here = 1;
    MPI_Comm_size(machine_, &here);
    if (here == 1) return;
    constexpr MPI_Aint list_bytes = 64;  // a cache line each: ranks do not wait for each other's
    static_assert(sizeof(WorkList) <= list_bytes && std::is_trivially_destructible_v<WorkList>);
    void* mine = nullptr;
    MPI_Win_allocate_shared(list_bytes, 1, MPI_INFO_NULL, machine_, &mine, &shared_memory_);
    new (mine) WorkList;

    std::vector<int> world_ranks(static_cast<size_t>(here));
    MPI_Allgather(&rank_, 1, MPI_INT, world_ranks.data(), 1, MPI_INT, machine_);
    work_lists_.assign(static_cast<size_t>(size_), nullptr);
    for (int r = 0; r < here; ++r) {
        MPI_Aint bytes = 0;
        int unit = 0;
        void* list = nullptr;
        MPI_Win_shared_query(shared_memory_, r, &bytes, &unit, &list);
        work_lists_[static_cast<size_t>(world_ranks[static_cast<size_t>(r)])] =
            static_cast<WorkList*>(list);
    }
    MPI_Barrier(machine_);  // all lists are made before any is looked at
}

MpiCommunicator::~MpiCommunicator() {
    if (std::uncaught_exceptions() > 0) abort_all_ranks(rank_, "ended by an exception");
    try {
        if (!failure_) begin(Call::leave, {});
    } catch (const RankFailure&) {  // all ranks have heard of it, and leave as this one does
    } catch (const std::exception& error) {
        abort_all_ranks(rank_, error.what());
    }
    if (shared_memory_ != MPI_WIN_NULL) MPI_Win_free(&shared_memory_);
    MPI_Comm_free(&machine_);
    MPI_Finalize();
}

MpiCommunicator::Headers MpiCommunicator::exchange(Header mine) const {
    constexpr int numbers = 4;
    static_assert(std::is_trivially_copyable_v<Header> &&
                  sizeof(Header) == numbers * sizeof(int64_t));
    Headers all(static_cast<size_t>(size_));
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallgather(&mine, numbers, MPI_INT64_T, all.data(), numbers, MPI_INT64_T, MPI_COMM_WORLD,
                   &request);
    wait_for(request);
    return all;
}

MpiCommunicator::Headers MpiCommunicator::begin(Call call, const std::string& bytes, int to) {
    if (failure_) throw RankFailure(*failure_);
    Headers headers = exchange({call, static_cast<int64_t>(bytes.size()), 0, to});
    hear_of_failure(headers, {});
    if (failure_) throw RankFailure(*failure_);
    for (const Header& header : headers) {
        if (header.call != call) throw std::logic_error("ranks make different calls");
    }
    return headers;
}

void MpiCommunicator::hear_of_failure(const Headers& headers, const std::string& mine) {
    const auto failed = std::find_if(headers.begin(), headers.end(), [](const Header& header) {
        return header.call == Call::fail;
    });
    if (failed == headers.end()) return;
    for (int r = 0; r < size_; ++r) {  // what they sent for check() to find
        if (r == rank_ || headers[static_cast<size_t>(r)].call != Call::fail) continue;
        MPI_Recv(nullptr, 0, MPI_BYTE, r, failure_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    }
    const auto rank = static_cast<int>(failed - headers.begin());
    std::string message =
        rank == rank_ ? mine : std::string(static_cast<size_t>(failed->length), '\0');
    broadcast_from(rank, message);
    failure_.emplace(static_cast<ExitCode>(failed->code),
                     "rank " + std::to_string(rank) + ": " + message);
}

ExitCode MpiCommunicator::fail(ExitCode code, const std::string& message) noexcept {
    if (!failure_) {
        std::vector<MPI_Request> sent;
        for (int r = 0; r < size_; ++r) {
            if (r == rank_) continue;
            MPI_Isend(nullptr, 0, MPI_BYTE, r, failure_tag, MPI_COMM_WORLD, &sent.emplace_back());
        }
        hear_of_failure(exchange({Call::fail, static_cast<int64_t>(message.size()),
                                  static_cast<int64_t>(code), nobody}),
                        message);
        MPI_Waitall(static_cast<int>(sent.size()), sent.data(), MPI_STATUSES_IGNORE);
    }
    return failure_->exit_code();
}

std::vector<std::string> MpiCommunicator::gather_to_all(std::string bytes) {
    const Headers headers = begin(Call::gather_to_all, bytes);
    return move_or_abort(rank_, [&] {
        uint64_t total = 0;
        for (const Header& header : headers) total += static_cast<uint64_t>(header.length);
        return total <= largest_message_ ? gather_at_once(headers, bytes)
                                         : gather_in_turn(headers, std::move(bytes));
    });
}

std::vector<std::string> MpiCommunicator::gather_at_once(const Headers& headers,
                                                         const std::string& bytes) const {
    std::vector<int> lengths, firsts;
    int total = 0;
    for (const Header& header : headers) {
        lengths.push_back(static_cast<int>(header.length));
        firsts.push_back(total);
        total += lengths.back();
    }
    std::string joined(static_cast<size_t>(total), '\0');
    MPI_Allgatherv(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, joined.data(),
                   lengths.data(), firsts.data(), MPI_BYTE, MPI_COMM_WORLD);
    std::vector<std::string> all;
    for (size_t r = 0; r < headers.size(); ++r) {
        all.emplace_back(joined, static_cast<size_t>(firsts[r]), static_cast<size_t>(lengths[r]));
    }
    return all;
}

std::vector<std::string> MpiCommunicator::gather_in_turn(const Headers& headers,
                                                         std::string bytes) const {
    std::vector<std::string> all(headers.size());
    all[static_cast<size_t>(rank_)] = std::move(bytes);
    for (int rank = 0; rank < size_; ++rank) {
        const auto r = static_cast<size_t>(rank);
        all[r].resize(static_cast<size_t>(headers[r].length));
        broadcast_from(rank, all[r]);
    }
    return all;
}

std::vector<std::string> MpiCommunicator::gather(std::string bytes) {
    const Headers headers = begin(Call::gather, bytes);
    return move_or_abort(rank_, [&] {
        std::vector<std::string> all;
        if (!is_root()) {
            in_parts(bytes, [](char* first, int count) {
                MPI_Send(first, count, MPI_BYTE, 0, message_tag, MPI_COMM_WORLD);
            });
            return all;
        }
        all.push_back(std::move(bytes));
        for (int rank = 1; rank < size_; ++rank) {
            all.emplace_back(static_cast<size_t>(headers[static_cast<size_t>(rank)].length), '\0');
            in_parts(all.back(), [rank](char* first, int count) {
                MPI_Recv(first, count, MPI_BYTE, rank, message_tag, MPI_COMM_WORLD,
                         MPI_STATUS_IGNORE);
            });
        }
        return all;
    });
}

std::string MpiCommunicator::broadcast(std::string bytes) {
    const Headers headers = begin(Call::broadcast, bytes);
    return move_or_abort(rank_, [&] {
        if (!is_root()) bytes.assign(static_cast<size_t>(headers.front().length), '\0');
        broadcast_from(0, bytes);
        return std::move(bytes);
    });
}

std::string MpiCommunicator::pass(int to, std::string bytes) {
    const Headers headers = begin(Call::pass, bytes, to);
    return move_or_abort(rank_, [&] {
        const auto from = std::find_if(headers.begin(), headers.end(),
                                       [&](const Header& header) { return header.to == rank_; });
        std::string received;
        if (from != headers.end()) received.resize(static_cast<size_t>(from->length));
        std::vector<MPI_Request> moving;
        in_parts(received, [&](char* first, int count) {
            MPI_Irecv(first, count, MPI_BYTE, static_cast<int>(from - headers.begin()), message_tag,
                      MPI_COMM_WORLD, &moving.emplace_back());
        });
        if (to == nobody) bytes.clear();
        in_parts(bytes, [&](char* first, int count) {
            MPI_Isend(first, count, MPI_BYTE, to, message_tag, MPI_COMM_WORLD,
                      &moving.emplace_back());
        });
        MPI_Waitall(static_cast<int>(moving.size()), moving.data(), MPI_STATUSES_IGNORE);
        return received;
    });
}

void MpiCommunicator::check() {
    int failed = 0;
    if (!failure_) {
        MPI_Iprobe(MPI_ANY_SOURCE, failure_tag, MPI_COMM_WORLD, &failed, MPI_STATUS_IGNORE);
    }
    if (failed || failure_) begin(Call::check, {});  // the round in which the failed rank waits
}

template <class Pass>
void MpiCommunicator::in_parts(std::string& bytes, Pass pass) const {
    for (size_t first = 0; first < bytes.size(); first += largest_message_) {
        pass(bytes.data() + first,
             static_cast<int>(std::min(largest_message_, bytes.size() - first)));
    }
}

void MpiCommunicator::broadcast_from(int rank, std::string& bytes) const {
    in_parts(bytes, [rank](char* first, int count) {
        MPI_Bcast(first, count, MPI_BYTE, rank, MPI_COMM_WORLD);
    });
}

}  // namespace kinetome
