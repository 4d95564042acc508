#include "kinetome/base/parallel.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

void add(double& left, const double& right) {
    left += right;
}
using DoubleTree = FixedTree<double, decltype(&add)>;

/// Values of both signs and of very different sizes, so that the order of a sum shows in its bits.
std::vector<double> sensitive_values(size_t count) {
    RandomStream random(1, "values");
    std::vector<double> values(count);
    for (double& value : values) value = random.normal() * std::exp(10 * random.normal());
    return values;
}

/// The tree by its definition, one level after the other.
template <class Sum, class Merge>
Sum tree_sum(std::vector<Sum> level, Merge merge) {
    while (level.size() > 1) {
        std::vector<Sum> above;
        for (size_t i = 0; i < level.size(); i += 2) {
            above.push_back(level[i]);
            if (i + 1 < level.size()) merge(above.back(), level[i + 1]);
        }
        level = std::move(above);
    }
    return level.front();
}

std::vector<size_t> shuffled(size_t count, RandomStream& random) {
    std::vector<size_t> order(count);
    std::iota(order.begin(), order.end(), size_t{0});
    for (size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    return order;
}

std::vector<ClipExtent> some_clips() {
    RandomStream random(1, "clips");
    std::vector<ClipExtent> clips;
    for (int i = 0; i < 120; ++i) {
        const auto frames = int64_t(1 + random.below(2500));
        clips.push_back({random(), frames, i % 5 == 0 ? 0 : frames});
    }
    clips[60] = {0, group_frames, 0};  // between two cuts: a group without rows
    clips[59].claimed = group_frames;
    return clips;
}

void pause_now_and_then(int64_t item) {
    if (item % 3 == 0) std::this_thread::sleep_for(std::chrono::microseconds(100 * (item % 7)));
}

}  // namespace

TEST_CASE("a loop visits every item once, for any number of threads") {
    for (const int threads : {1, 2, 3, 7}) {
        for (const int64_t count : {0, 1, 2, 1000}) {
            std::vector<std::atomic<int>> visits(static_cast<size_t>(count));
            parallel_for(threads, count, [&](int64_t i) { ++visits[static_cast<size_t>(i)]; });
            for (const auto& visit : visits) REQUIRE(visit == 1);
        }
    }
}

TEST_CASE("a loop uses the threads it was given") {
    std::atomic<int> together{0}, most{0};
    parallel_for(2, 2, [&](int64_t) {
        most = std::max(most.load(), ++together);
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
        while (most < 2 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
        --together;
    });
    CHECK(most == 2);
}

TEST_CASE("the exception that leaves a loop is the one a single thread would meet first") {
    for (const int threads : {1, 2, 3, 7}) {
        for (int repeat = 0; repeat < 20; ++repeat) {
            const auto body = [](int64_t i) {
                if (i == 37) std::this_thread::sleep_for(std::chrono::milliseconds(2));
                if (i == 37 || i == 38 || i == 41) throw std::runtime_error(std::to_string(i));
            };
            CHECK_THROWS_WITH(parallel_for(threads, 100, body), "37");
        }
    }
}

TEST_CASE("after an exception no further item starts") {
    constexpr int64_t count = 100'000;
    for (const int threads : {1, 2, 3, 7}) {
        std::atomic<int64_t> started{0};
        const auto body = [&](int64_t i) {
            ++started;
            if (i == 5) throw std::runtime_error("five");
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        };
        CHECK_THROWS_WITH(parallel_for(threads, count, body), "five");
        CHECK(started < 1000);
    }
}

TEST_CASE("a loop works again after one that threw") {
    CHECK_THROWS(parallel_for(3, 10, [](int64_t) { throw std::runtime_error("no"); }));
    std::atomic<int64_t> sum{0};
    parallel_for(3, 10, [&](int64_t i) { sum += i; });
    CHECK(sum == 45);
}

TEST_CASE("a tree gives the same bits whatever the order of arrival") {
    RandomStream random(1, "order");
    for (size_t count = 1; count <= 40; ++count) {
        const auto values = sensitive_values(count);
        const double expected = tree_sum(values, add);
        for (int repeat = 0; repeat < 10; ++repeat) {
            DoubleTree tree(int64_t(count), add);
            for (const size_t i : shuffled(count, random)) tree.insert_leaf(int64_t(i), values[i]);
            REQUIRE(tree.take_root() == expected);
            REQUIRE(tree.take_waiting().empty());
        }
    }
}

TEST_CASE("siblings are merged left before right, whoever comes second") {
    const auto join = [](std::string& left, const std::string& right) {
        left = "(" + left + right + ")";
    };
    RandomStream random(1, "sides");
    for (int repeat = 0; repeat < 50; ++repeat) {
        FixedTree<std::string, decltype(join)> tree(7, join);
        for (const size_t i : shuffled(7, random)) tree.insert_leaf(int64_t(i), {char('a' + i)});
        CHECK(tree.take_root() == "(((ab)(cd))((ef)g))");
    }
}

TEST_CASE("a tree has no sum before the last leaf is in, or without leaves") {
    DoubleTree tree(3, add);
    tree.insert_leaf(2, 1);
    tree.insert_leaf(0, 1);
    CHECK_FALSE(tree.take_root());
    tree.insert_leaf(1, 1);
    CHECK(tree.take_root() == 3);
    CHECK_FALSE(DoubleTree(0, add).take_root());
}

TEST_CASE("leaves summed on several ranks and sent as subtrees give the bits of one rank") {
    RandomStream random(1, "ranks");
    for (size_t count = 1; count <= 40; ++count) {
        const auto values = sensitive_values(count);
        const double expected = tree_sum(values, add);
        for (const size_t ranks : {2, 3, 5}) {
            // Any division, also one in which some rank has nothing to do.
            std::vector<size_t> rank_of(count);
            for (size_t& rank : rank_of) rank = random.below(ranks);
            if (count % 2 == 0) std::sort(rank_of.begin(), rank_of.end());
            DoubleTree whole(int64_t(count), add);
            for (size_t rank = 0; rank < ranks; ++rank) {
                DoubleTree part(int64_t(count), add);
                for (size_t i = 0; i < count; ++i) {
                    if (rank_of[i] == rank) part.insert_leaf(int64_t(i), values[i]);
                }
                for (auto& [node, sum] : part.take_waiting()) {
                    whole.insert(node.first, node.second, sum);
                }
            }
            REQUIRE(whole.take_root() == expected);
        }
    }
}

TEST_CASE("sums over pieces have the same bits for 1, 2, 3 and 7 threads") {
    const PieceLayout layout = layout_pieces(some_clips());
    REQUIRE(layout.group_count() > 10);
    const auto values = sensitive_values(size_t(layout.rows()));
    const auto leaf = [&](const RowRange& rows) {
        pause_now_and_then(rows.first);
        return std::accumulate(values.begin() + rows.first, values.begin() + rows.end, 0.0);
    };

    // The same tree by its definition: pieces in groups, groups above, empty ones in their place.
    std::vector<std::optional<double>> groups;
    for (size_t g = 0; g + 1 < layout.group_first.size(); ++g) {
        std::vector<double> leaves;
        for (int64_t p = layout.group_first[g]; p < layout.group_first[g + 1]; ++p) {
            leaves.push_back(leaf(layout.pieces[size_t(p)]));
        }
        groups.push_back(leaves.empty() ? std::nullopt : std::optional(tree_sum(leaves, add)));
    }
    REQUIRE(std::count(groups.begin(), groups.end(), std::nullopt) > 0);
    const auto expected = tree_sum(groups, [](std::optional<double>& left, const auto& right) {
        if (left && right) {
            *left += *right;
        } else if (right) {
            left = right;
        }
    });

    for (const int threads : {1, 2, 3, 7}) {
        for (int repeat = 0; repeat < 3; ++repeat) {
            CHECK(sum_pieces<double>(threads, layout, leaf, add) == expected);
        }
    }
    // The values can tell: another order gives other bits.
    CHECK(std::accumulate(values.begin(), values.end(), 0.0) != *expected);
}

TEST_CASE("a sum over nothing is nothing") {
    const auto leaf = [](const RowRange& rows) { return double(rows.size()); };
    CHECK_FALSE(sum_pieces<double>(3, layout_rows(0), leaf, add));
    std::vector<ClipExtent> without_rows = some_clips();
    for (ClipExtent& clip : without_rows) clip.rows = 0;
    CHECK_FALSE(sum_pieces<double>(3, layout_pieces(without_rows), leaf, add));
}

TEST_CASE("an exception in a piece leaves the sum") {
    const auto leaf = [](const RowRange& rows) -> double {
        if (rows.first >= 3 * piece_frames) throw std::runtime_error(std::to_string(rows.first));
        return 0;
    };
    for (const int threads : {1, 2, 3, 7}) {
        CHECK_THROWS_WITH(sum_pieces<double>(threads, layout_rows(20 * piece_frames), leaf, add),
                          std::to_string(3 * piece_frames));
    }
}
