#include "kinetome/stages/rank_schedule.h"

#include <catch2/catch.hpp>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

LoadItem item(double seconds, int64_t pieces) {
    const auto frames = static_cast<int64_t>(seconds * 1000);
    return {.amount = frames,
            .seconds = seconds,
            .fixed_seconds = 0,
            .pieces = pieces,
            .exchanged_bytes = 0};
}

StageLoad shards(const std::vector<double>& seconds) {
    StageLoad load;
    for (const double one : seconds) load.items.push_back(item(one, 100));
    return load;
}

StageLoad partitions(const std::vector<double>& seconds, int64_t pieces) {
    StageLoad load;
    for (const double one : seconds) load.items.push_back(item(one, pieces));
    load.shares_items = true;
    return load;
}

std::vector<double> random_seconds(RandomStream& random) {
    std::vector<double> seconds(1 + random.below(40));
    for (double& one : seconds) one = random.uniform(0.01, 10);
    return seconds;
}

}  // namespace

TEST_CASE("nothing to do takes no time, on any number of ranks") {
    CHECK(load_seconds({}, 1, 1) == 0);
    CHECK(load_seconds({}, 2, 7) == 0);
    CHECK(ranks_that_help(tabulate_ranks([](int) { return 0.0; })) == 1);
}

TEST_CASE("one rank with one thread takes the sum") {
    CHECK(load_seconds(shards({3, 5, 2}), 1, 1) == Approx(10));
    CHECK(load_seconds(partitions({3, 5, 2}, 8), 1, 1) == Approx(10));
}

TEST_CASE("shards are given longest first, and the largest bounds their stage") {
    CHECK(load_seconds(shards({3, 3, 2, 2, 2}), 1, 2) == Approx(7));  // 3 + 2 + 2, 3 + 2
    CHECK(load_seconds(shards({5, 4, 3, 2, 1}), 1, 3) == Approx(5));
    CHECK(load_seconds(shards({9, 1, 1}), 1, 8) == Approx(9));
}

TEST_CASE("a partition above a rank's share is worked on by all, piece by piece") {
    CHECK(load_seconds(partitions({8}, 8), 1, 2) == Approx(4));
    CHECK(load_seconds(partitions({8}, 8), 1, 3) == Approx(3));  // three pieces at one of the ranks
    CHECK(load_seconds(partitions({8}, 8), 2, 4) == Approx(1));
    CHECK(load_seconds(partitions({8}, 8), 1, 100) == Approx(1));  // a piece is not divided
    // 6 of 8 seconds are more than half of them: all share those, then one rank does each small
    // one.
    CHECK(load_seconds(partitions({6, 1, 1}, 8), 1, 2) == Approx(3 + 1));
}

TEST_CASE("partitions of a rank's share or less stay whole") {
    CHECK(load_seconds(partitions({4, 4}, 1000), 1, 2) == Approx(4));
    CHECK(load_seconds(partitions({3, 3, 3, 3}, 1000), 1, 2) == Approx(6));
}

TEST_CASE("threads shorten an item but for its serial share and its number of pieces") {
    StageLoad load = shards({10});
    load.serial_share = 0.2;
    CHECK(load_seconds(load, 2, 1) == Approx(2 + 4));
    load.items[0].pieces = 1;
    CHECK(load_seconds(load, 2, 1) == Approx(10));
    load.items[0] = {
        .amount = 1, .seconds = 0, .fixed_seconds = 3, .pieces = 8, .exchanged_bytes = 0};
    CHECK(load_seconds(load, 4, 1) == Approx(3));
}

TEST_CASE("what ranks exchange costs them, the more the more they are") {
    StageLoad load = partitions({8}, 1'000'000);
    const double without = load_seconds(load, 1, 64);
    load.items[0].exchanged_bytes = 1e8;
    CHECK(load_seconds(load, 1, 64) > without + 1);
    CHECK(load_seconds(load, 1, 1) == Approx(8));
    const auto table = tabulate_ranks([&](int ranks) { return load_seconds(load, 1, ranks); });
    CHECK(ranks_that_help(table) == 8);  // 8, 4.2, 2.4, 1.8, 2.1
}

TEST_CASE("more threads, more ranks and less work never cost more where nothing is exchanged") {
    RandomStream random(1, "loads");
    for (int turn = 0; turn < 200; ++turn) {
        StageLoad load = shards(random_seconds(random));
        load.serial_share = random.uniform(0, 0.5);
        double before = load_seconds(load, 1, 1);
        for (int ranks = 2; ranks <= 50; ++ranks) {
            const double seconds = load_seconds(load, 1, ranks);
            CHECK(seconds <= before * (1 + 1e-12));
            before = seconds;
        }
        for (const int ranks : {1, 3}) {
            for (int threads = 1; threads < 8; ++threads) {
                CHECK(load_seconds(load, threads + 1, ranks) <=
                      load_seconds(load, threads, ranks) * (1 + 1e-12));
            }
        }
        const double all = load_seconds(load, 2, 1);
        load.items.pop_back();
        CHECK(load_seconds(load, 2, 1) < all);
    }
}

TEST_CASE("a whole corpus in one partition gains from every rank until each has one piece") {
    const StageLoad load = partitions({100}, 64);
    double before = 101;
    for (int ranks = 1; ranks <= 64; ranks *= 2) {
        CHECK(load_seconds(load, 1, ranks) == Approx(100.0 / ranks));
        CHECK(load_seconds(load, 1, ranks) < before);
        before = load_seconds(load, 1, ranks);
    }
    const auto table = tabulate_ranks([&](int ranks) { return load_seconds(load, 1, ranks); });
    CHECK(ranks_that_help(table) == 64);
    CHECK(table.back() == RankSeconds{128, table[table.size() - 2].seconds});
}

TEST_CASE("the table ends with the first count that gains less than a tenth") {
    const auto seconds = [](int ranks) { return ranks >= 4 ? 47.0 : 100.0 / ranks; };
    const auto table = tabulate_ranks(seconds);
    CHECK(table == std::vector<RankSeconds>{{1, 100}, {2, 50}, {4, 47}});
    CHECK(ranks_that_help(table) == 2);
    CHECK(tabulate_ranks([](int ranks) { return 1.0 / ranks; }, 8).back().ranks == 8);
}
