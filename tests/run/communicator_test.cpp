#include "kinetome/base/communicator.h"

#include <catch2/catch.hpp>

#include "support/communicator_cases.h"
#include "support/thread_ranks.h"

using namespace kinetome;
namespace cases = communicator_cases;

namespace {

std::string message_of(const RankOutcome& outcome) {
    try {
        if (outcome.thrown) std::rethrow_exception(outcome.thrown);
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

ExitCode code_of(const RankOutcome& outcome) {
    try {
        if (outcome.thrown) std::rethrow_exception(outcome.thrown);
    } catch (const Error& error) {
        return error.exit_code();
    } catch (const std::exception&) {
        return ExitCode::internal;
    }
    return ExitCode::success;
}

}  // namespace

TEST_CASE("one process keeps the promises of ranks", "[communicator]") {
    for (const auto& [name, body] : cases::peaceful) {
        INFO(name);
        SerialCommunicator alone;
        CHECK_NOTHROW(body(alone));
    }
}

TEST_CASE("threads keep the promises of ranks", "[communicator]") {
    for (const int count : {1, 2, 3, 4, 7}) {
        for (const auto& [name, body] : cases::peaceful) {
            INFO(name << ", " << count << " ranks");
            CHECK_NOTHROW(run_as_ranks(count, body));
        }
    }
}

TEST_CASE("a rank that fails ends all ranks with its code and message", "[communicator]") {
    for (const int count : {2, 3, 5}) {
        for (const auto& [name, body] : cases::failing) {
            INFO(name << ", " << count << " ranks");
            const auto outcomes = outcomes_of_ranks(count, body);
            for (const RankOutcome& outcome : outcomes) {
                CHECK(code_of(outcome) == cases::code_of_failure);
                const bool failed = &outcome == &outcomes.back();
                const std::string news = "rank " + std::to_string(count - 1) + ": disk full";
                CHECK(message_of(outcome) == (failed ? "disk full" : news));
            }
        }
    }
}

TEST_CASE("of two ranks that fail at once, all others hear of the lower", "[communicator]") {
    const auto outcomes = outcomes_of_ranks(5, [](Communicator& ranks) {
        if (ranks.rank() == 3) throw Error(ExitCode::io, "third");
        if (ranks.rank() == 1) throw Error(ExitCode::usage, "first");
        ranks.broadcast("");
    });
    for (const size_t rank : {0u, 2u, 4u}) {
        CHECK(message_of(outcomes[rank]) == "rank 1: first");
        CHECK(code_of(outcomes[rank]) == ExitCode::usage);
        CHECK(outcomes[rank].is_news);
    }
    CHECK(message_of(outcomes[3]) == "third");
    CHECK_FALSE(outcomes[3].is_news);
}

TEST_CASE("all ranks may fail at once", "[communicator]") {
    const auto outcomes = outcomes_of_ranks(4, cases::every_rank_fails);
    for (size_t rank = 0; rank < outcomes.size(); ++rank) {
        CHECK(message_of(outcomes[rank]) == "disk full at " + std::to_string(rank));
    }
}

TEST_CASE("a failing rank learns the code that all end with", "[communicator]") {
    std::vector<ExitCode> heard(3);
    outcomes_of_ranks(3, [&](Communicator& ranks) {
        const auto code = ranks.rank() == 2 ? ExitCode::io : ExitCode::cannot_create;
        if (ranks.rank() > 0) heard[static_cast<size_t>(ranks.rank())] = ranks.fail(code, "end");
    });
    CHECK(heard[1] == ExitCode::cannot_create);
    CHECK(heard[2] == ExitCode::cannot_create);
}

TEST_CASE("what a rank threw is thrown to who started the ranks", "[communicator]") {
    CHECK_THROWS_AS(run_as_ranks(4,
                                 [](Communicator& ranks) {
                                     if (ranks.rank() == 2) throw std::out_of_range("mine");
                                     ranks.wait_for_all();
                                 }),
                    std::out_of_range);
}

TEST_CASE("ranks that make different calls are stopped, not left waiting", "[communicator]") {
    for (const RankOutcome& outcome : outcomes_of_ranks(3, cases::ranks_make_different_calls)) {
        CHECK(code_of(outcome) == ExitCode::internal);
        CHECK_THAT(message_of(outcome), Catch::Contains("different calls"));
    }
}
