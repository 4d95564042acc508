// Ranks that are threads of one process: distributed code is tested without MPI, by the same calls,
// with the same failures. Catch2's assertions are not thread-safe: bodies throw, or fill what the
// test looks at afterwards.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "kinetome/base/communicator.h"

/// Where the threads meet, once a call.
class MeetingPlace {
  public:
    enum class Call { none, gather_to_all, gather, broadcast, pass, check, leave, fail };
    struct Offer {
        Call call = Call::none;
        std::string bytes;
        kinetome::ExitCode code = kinetome::ExitCode::success;  ///< of a failing rank
        int to = kinetome::Communicator::nobody;                ///< who gets what is passed
    };
    using Offers = std::vector<Offer>;

    explicit MeetingPlace(int ranks)
        : offers_(static_cast<size_t>(ranks)), work_lists_(static_cast<size_t>(ranks)) {}

    int ranks() const { return static_cast<int>(offers_.size()); }

    std::vector<kinetome::WorkList*> work_lists() {
        std::vector<kinetome::WorkList*> lists;
        for (kinetome::WorkList& list : work_lists_) lists.push_back(&list);
        return lists;
    }

    void announce_failure() { failure_announced_ = true; }
    bool failure_announced() const { return failure_announced_; }

    /// Waits until all have come. What each brought.
    std::shared_ptr<const Offers> meet(int rank, Offer offer) {
        std::unique_lock lock(mutex_);
        const int64_t round = round_;
        offers_[static_cast<size_t>(rank)] = std::move(offer);
        if (++here_ == ranks()) {
            met_ = std::make_shared<Offers>(std::exchange(offers_, Offers(offers_.size())));
            here_ = 0;
            ++round_;
            all_are_here_.notify_all();
        } else {
            all_are_here_.wait(lock, [&] { return round_ != round; });
        }
        return met_;  // the next round cannot end before this rank has come again
    }

  private:
    std::atomic<bool> failure_announced_{false};
    std::mutex mutex_;
    std::condition_variable all_are_here_;
    int64_t round_ = 0;
    int here_ = 0;
    Offers offers_;
    std::shared_ptr<const Offers> met_;
    std::vector<kinetome::WorkList> work_lists_;
};

class ThreadCommunicator final : public kinetome::Communicator {
  public:
    ThreadCommunicator(MeetingPlace& place, int rank) : place_(place), rank_(rank) {}

    int rank() const override { return rank_; }
    int size() const override { return place_.ranks(); }

    std::vector<std::string> gather_to_all(std::string bytes) override {
        return bytes_of(*meet(Call::gather_to_all, std::move(bytes)));
    }
    std::vector<std::string> gather(std::string bytes) override {
        const auto offers = meet(Call::gather, std::move(bytes));
        return is_root() ? bytes_of(*offers) : std::vector<std::string>();
    }
    std::string broadcast(std::string bytes) override {
        return meet(Call::broadcast, std::move(bytes))->front().bytes;
    }
    std::string pass(int to, std::string bytes) override {
        const auto offers = meet(Call::pass, std::move(bytes), to);
        for (const auto& offer : *offers) {
            if (offer.to == rank_) return offer.bytes;
        }
        return {};
    }
    std::vector<kinetome::WorkList*> work_lists() override { return place_.work_lists(); }
    void check() override {
        if (failure_ || place_.failure_announced()) meet(Call::check, {});
    }
    kinetome::ExitCode fail(kinetome::ExitCode code, const std::string& message) noexcept override {
        place_.announce_failure();
        if (!failure_) failure_ = failure_in(*place_.meet(rank_, {Call::fail, message, code}));
        return failure_->exit_code();
    }
    /// The end of a rank that has nothing more to do. Throws RankFailure when another one failed.
    void leave() {
        if (!failure_) meet(Call::leave, {});
    }

  private:
    using Call = MeetingPlace::Call;
    using Offers = MeetingPlace::Offers;

    std::shared_ptr<const Offers> meet(Call call, std::string bytes, int to = nobody) {
        if (failure_) throw kinetome::RankFailure(*failure_);
        const auto offers =
            place_.meet(rank_, {call, std::move(bytes), kinetome::ExitCode::success, to});
        failure_ = failure_in(*offers);
        if (failure_) throw kinetome::RankFailure(*failure_);
        for (const auto& offer : *offers) {
            if (offer.call != call) throw std::logic_error("ranks make different calls");
        }
        return offers;
    }
    /// That of the lowest rank that failed.
    static std::optional<kinetome::RankFailure> failure_in(const Offers& offers) {
        for (size_t r = 0; r < offers.size(); ++r) {
            if (offers[r].call != Call::fail) continue;
            return kinetome::RankFailure(offers[r].code,
                                         "rank " + std::to_string(r) + ": " + offers[r].bytes);
        }
        return std::nullopt;
    }
    static std::vector<std::string> bytes_of(const Offers& offers) {
        std::vector<std::string> bytes;
        for (const auto& offer : offers) bytes.push_back(offer.bytes);
        return bytes;
    }

    MeetingPlace& place_;
    int rank_;
    std::optional<kinetome::RankFailure> failure_;
};

/// What a rank's body threw, and whether that was only the news of another rank's failure.
struct RankOutcome {
    std::exception_ptr thrown;
    bool is_news = false;
};

/// Calls body(Communicator&) as rank 0 … count - 1 of one run; how each ended, when all have.
template <class Body>
std::vector<RankOutcome> outcomes_of_ranks(int count, const Body& body) {
    MeetingPlace place(count);
    std::vector<RankOutcome> outcomes(static_cast<size_t>(count));
    const auto run_rank = [&](int rank) {
        ThreadCommunicator communicator(place, rank);
        const auto fail = [&](kinetome::ExitCode code, const std::string& message) {
            outcomes[static_cast<size_t>(rank)] = {std::current_exception()};
            communicator.fail(code, message);
        };
        try {
            body(static_cast<kinetome::Communicator&>(communicator));
            communicator.leave();
        } catch (const kinetome::RankFailure&) {
            outcomes[static_cast<size_t>(rank)] = {std::current_exception(), true};
        } catch (const kinetome::Error& error) {
            fail(error.exit_code(), error.what());
        } catch (const std::exception& error) {
            fail(kinetome::ExitCode::internal, error.what());
        }
    };
    {
        std::vector<std::jthread> ranks;
        for (int rank = 1; rank < count; ++rank) ranks.emplace_back(run_rank, rank);
        run_rank(0);
    }
    return outcomes;
}

/// The same; rethrows what the lowest failing rank threw.
template <class Body>
void run_as_ranks(int count, const Body& body) {
    const std::vector<RankOutcome> outcomes = outcomes_of_ranks(count, body);
    for (const bool news : {false, true}) {
        for (const RankOutcome& outcome : outcomes) {
            if (outcome.thrown && outcome.is_news == news) std::rethrow_exception(outcome.thrown);
        }
    }
}
