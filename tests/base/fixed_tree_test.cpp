#include "kinetome/base/fixed_tree.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <string>

#include "tree_reference.h"

using namespace kinetome;
using namespace kinetome::test;

namespace {

using DoubleTree = FixedTree<double, decltype(&add)>;

std::vector<size_t> shuffled(size_t count, RandomStream& random) {
    std::vector<size_t> order(count);
    std::iota(order.begin(), order.end(), size_t{0});
    for (size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    return order;
}

}  // namespace

TEST_CASE("a tree gives the same bits whatever the order of arrival") {
    RandomStream random(1, "order");
    for (size_t count = 1; count <= 40; ++count) {
        const auto values = sensitive_values(count);
        const double expected = tree_sum(values, add);
        for (int repeat = 0; repeat < 10; ++repeat) {
            DoubleTree tree(int64_t(count), add);
            for (const size_t i : shuffled(count, random)) tree.insert_leaf(int64_t(i), values[i]);
            REQUIRE(tree.take_root() == expected);
            REQUIRE(tree.waiting().empty());
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
                for (const auto& [node, sum] : part.waiting()) {
                    whole.insert(node.first, node.second, sum);
                }
            }
            REQUIRE(whole.take_root() == expected);
        }
    }
}
