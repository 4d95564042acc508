// What every communicator must do, whatever carries it: for ranks that are threads and for MPI.
// Each case is called by all ranks, and throws when a promise is broken.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "kinetome/base/communicator.h"

namespace communicator_cases {

using kinetome::Communicator;

inline void expect(bool kept, const std::string& promise) {
    if (!kept) throw std::runtime_error("broken promise: " + promise);
}

/// Differs between ranks in length and in every byte; holds zeros.
inline std::string message_of(int rank, size_t length) {
    std::string bytes(length + static_cast<size_t>(rank), '\0');
    for (size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] = static_cast<char>(31 * (rank + 1) + static_cast<int>(i) * 7);
    }
    return bytes;
}

inline std::vector<std::string> messages_of_all(const Communicator& ranks, size_t length) {
    std::vector<std::string> messages;
    for (int rank = 0; rank < ranks.size(); ++rank) messages.push_back(message_of(rank, length));
    return messages;
}

inline void messages_arrive_in_rank_order(Communicator& ranks) {
    for (const size_t length : {0, 1, 100, 5000}) {
        const auto all = messages_of_all(ranks, length);
        const std::string mine = message_of(ranks.rank(), length);
        expect(ranks.gather_to_all(mine) == all, "gather_to_all in rank order, at every rank");
        const auto gathered = ranks.gather(mine);
        expect(ranks.is_root() ? gathered == all : gathered.empty(),
               "gather in rank order, at rank 0 alone");
        expect(ranks.broadcast(mine) == all[0], "broadcast of what rank 0 brought");
    }
}

inline void nothing_is_a_message_too(Communicator& ranks) {
    const std::vector<std::string> nothing(static_cast<size_t>(ranks.size()));
    expect(ranks.gather_to_all({}) == nothing, "gather_to_all of nothing");
    expect(ranks.gather({}).size() == (ranks.is_root() ? nothing.size() : 0), "gather of nothing");
    expect(ranks.broadcast(ranks.is_root() ? "" : "ignored").empty(), "broadcast of nothing");
    // The last rank alone has something to say.
    auto last = nothing;
    last.back() = "something";
    const std::string mine = last[static_cast<size_t>(ranks.rank())];
    expect(ranks.gather_to_all(mine) == last, "gather_to_all of nothing but one");
    const auto gathered = ranks.gather(mine);
    expect(!ranks.is_root() || gathered == last, "gather of nothing but one");
}

inline void calls_in_a_row_do_not_mix(Communicator& ranks) {
    for (int round = 0; round < 300; ++round) {
        const std::string said = std::to_string(round);
        switch (round % 4) {
            case 0:
                expect(ranks.broadcast(said) == said, "broadcast of this round");
                break;
            case 1:
                for (const auto& heard : ranks.gather_to_all(said)) {
                    expect(heard == said, "gather_to_all of this round");
                }
                break;
            case 2:
                for (const auto& heard : ranks.gather(said)) {
                    expect(heard == said, "gather of this round");
                }
                break;
            default:
                ranks.wait_for_all();
        }
    }
}

inline void messages_are_passed_round_and_to_nobody(Communicator& ranks) {
    for (const size_t length : {0, 1, 5000}) {
        const int to = (ranks.rank() + 1) % ranks.size();
        const int from = (ranks.rank() + ranks.size() - 1) % ranks.size();
        const std::string round = ranks.pass(to, message_of(ranks.rank(), length));
        expect(ranks.size() == 1 || round == message_of(from, length), "pass to the next rank");
        // Rank 0 alone gets something, from the last.
        const bool gives = ranks.size() > 1 && ranks.rank() == ranks.size() - 1;
        const std::string received =
            ranks.pass(gives ? 0 : Communicator::nobody, message_of(ranks.rank(), length));
        const bool gets = ranks.size() > 1 && ranks.is_root();
        expect(received == (gets ? message_of(ranks.size() - 1, length) : ""), "pass to rank 0");
        ranks.check();
    }
}

using Case = std::function<void(Communicator&)>;

/// These end well, for any number of ranks.
inline const std::map<std::string, Case> peaceful = {
    {"messages arrive in rank order", messages_arrive_in_rank_order},
    {"nothing is a message too", nothing_is_a_message_too},
    {"calls in a row do not mix", calls_in_a_row_do_not_mix},
    {"messages are passed round and to nobody", messages_are_passed_round_and_to_nobody},
};

constexpr kinetome::ExitCode code_of_failure = kinetome::ExitCode::cannot_create;

/// Fails at the last rank when the others are in `call`, or have nothing more to do.
inline Case last_rank_fails_in(Case call) {
    return [call](Communicator& ranks) {
        ranks.wait_for_all();
        if (ranks.rank() == ranks.size() - 1) throw kinetome::Error(code_of_failure, "disk full");
        call(ranks);
    };
}

/// Ends with code_of_failure, and rank 0's message.
inline void every_rank_fails(Communicator& ranks) {
    ranks.wait_for_all();
    throw kinetome::Error(code_of_failure, "disk full at " + std::to_string(ranks.rank()));
}

inline void later_calls_fail_too(Communicator& ranks) {
    if (ranks.rank() == ranks.size() - 1) throw kinetome::Error(code_of_failure, "disk full");
    int thrown = 0;
    for (int call = 0; call < 3; ++call) {
        try {
            ranks.broadcast("?");
        } catch (const kinetome::RankFailure&) {
            ++thrown;
        }
    }
    expect(thrown == 3, "every call throws after a failure");
    ranks.wait_for_all();
}

/// For two ranks or more: end with code_of_failure everywhere, and the last rank's "disk full".
inline const std::map<std::string, Case> failing = {
    {"a rank fails while others gather to all",
     last_rank_fails_in([](Communicator& ranks) { ranks.gather_to_all("message"); })},
    {"a rank fails while others gather",
     last_rank_fails_in([](Communicator& ranks) { ranks.gather("message"); })},
    {"a rank fails while others broadcast",
     last_rank_fails_in([](Communicator& ranks) { ranks.broadcast("message"); })},
    {"a rank fails while others pass",
     last_rank_fails_in([](Communicator& ranks) { ranks.pass(Communicator::nobody, ""); })},
    {"a rank fails while others work on their own", last_rank_fails_in([](Communicator& ranks) {
         for (int looked = 0; looked < 20'000; ++looked) {
             ranks.check();
             std::this_thread::sleep_for(std::chrono::milliseconds(1));
         }
         throw std::runtime_error("broken promise: check() hears of a failure");
     })},
    {"a rank fails when others have finished", last_rank_fails_in([](Communicator&) {})},
    {"later calls fail too", later_calls_fail_too},
};

/// A bug: ends with ExitCode::internal instead of waiting for ever.
inline void ranks_make_different_calls(Communicator& ranks) {
    if (ranks.is_root()) {
        ranks.broadcast("message");
    } else {
        ranks.gather("message");
    }
}

}  // namespace communicator_cases
