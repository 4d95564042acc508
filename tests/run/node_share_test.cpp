#include "kinetome/run/node_share.h"

#include <catch2/catch.hpp>

#include "support/thread_ranks.h"

using namespace kinetome;

TEST_CASE("ranks of one node share it, and its processors when they are not bound apart",
          "[node share]") {
    const std::vector<Place> places = {{"a", "0-7"}, {"b", "0-3"}, {"a", "0-7"},
                                       {"b", "4-7"}, {"a", "0-7"}, {"c", "0-7"}};
    const auto shares = [&](size_t rank) {
        const NodeShare share = node_share(places, rank);
        return std::pair(share.ranks, share.same_processors);
    };
    CHECK(shares(0) == std::pair(3, 3));
    CHECK(shares(4) == std::pair(3, 3));
    CHECK(shares(1) == std::pair(2, 1));
    CHECK(shares(3) == std::pair(2, 1));
    CHECK(shares(5) == std::pair(1, 1));
}

TEST_CASE("one process shares with nobody", "[node share]") {
    SerialCommunicator alone;
    const NodeShare share = node_share(alone);
    CHECK(share.ranks == 1);
    CHECK(share.same_processors == 1);
}

TEST_CASE("ranks that run on this very machine find that they share it", "[node share]") {
    std::vector<NodeShare> shares(3);
    run_as_ranks(3, [&](Communicator& ranks) {
        shares[static_cast<size_t>(ranks.rank())] = node_share(ranks);
    });
    for (const NodeShare& share : shares) {
        CHECK(share.ranks == 3);
        CHECK(share.same_processors == 3);
    }
}
