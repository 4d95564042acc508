#include "kinetome/math/warp.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

MatrixF wandering(int64_t frames, int64_t columns, uint64_t seed) {
    RandomStream random(seed, "wandering");
    MatrixF rows = MatrixF::Zero(frames, columns);
    for (int64_t i = 0; i < frames; ++i) {
        for (int64_t j = 0; j < columns; ++j) {
            const float before = i == 0 ? 0.0F : rows(i - 1, j);
            rows(i, j) = before + static_cast<float>(random.uniform() - 0.5);
        }
    }
    return rows;
}

double distance(const MatrixF& a, int64_t i, const MatrixF& b, int64_t j) {
    double squares = 0;
    for (int64_t c = 0; c < a.cols(); ++c) {
        squares += std::pow(double(a(i, c)) - double(b(j, c)), 2);
    }
    return std::sqrt(squares);
}

/// Tries every path, cell after cell: nothing that the table takes for granted.
class EveryPath {
  public:
    EveryPath(const MatrixF& first, const MatrixF& second, const WarpOptions& options)
        : first_(first), second_(second), options_(options) {
        for (int64_t i = 0; i <= std::min(options.end_slip, first.rows() - 1); ++i) begin_at(i, 0);
        for (int64_t j = 1; j <= std::min(options.end_slip, second.rows() - 1); ++j) begin_at(0, j);
    }

    double least_total = infinite;
    double weights = 0;                           ///< of the cheapest paths
    std::vector<std::vector<WarpCell>> cheapest;  ///< all of that total

  private:
    double weight(int64_t i, int64_t j) const {
        if (options_.weight == WarpWeight::cells) return 1;
        return double(options_.weight == WarpWeight::first ? i : i + j);
    }
    double slipped(int64_t i, int64_t j) const {
        return options_.weight == WarpWeight::cells ? 0 : weight(i, j);
    }

    void begin_at(int64_t i, int64_t j) { go_to(i, j, weight(i + 1, j + 1), 0, 0); }

    void go_to(int64_t i, int64_t j, double cell_weight, double total, double sum) {
        const double here = distance(first_, i, second_, j);
        if (here > options_.radius) return;
        total += cell_weight * here;
        sum += cell_weight;
        path_.push_back({static_cast<int32_t>(i), static_cast<int32_t>(j)});
        const int64_t left = first_.rows() - 1 - i, right = second_.rows() - 1 - j;
        if (std::min(left, right) == 0 && std::max(left, right) <= options_.end_slip) {
            const double extra = slipped(left, right);
            end_at(total + extra * here, sum + extra);
        }
        for (const WarpStep& step : options_.steps) {
            if (step.first > left || step.second > right) continue;
            go_to(i + step.first, j + step.second, weight(step.first, step.second), total, sum);
        }
        path_.pop_back();
    }

    void end_at(double total, double sum) {
        if (total > least_total) return;
        if (total < least_total) cheapest.clear();
        least_total = total;
        weights = sum;
        cheapest.push_back(path_);
    }

    const MatrixF& first_;
    const MatrixF& second_;
    const WarpOptions& options_;
    std::vector<WarpCell> path_;
};

std::vector<WarpOptions> every_kind() {
    const std::vector<WarpStep> paper{{1, 1}, {0, 1}, {1, 0}, {2, 1}, {1, 2}, {2, 2}, {5, 5}};
    std::vector<WarpOptions> kinds;
    for (const auto& steps : {slope_limited_steps(), unlimited_steps(), paper}) {
        for (const auto weight : {WarpWeight::both, WarpWeight::first, WarpWeight::cells}) {
            for (const int64_t slip : {0, 1, 2}) {
                kinds.push_back({steps, weight, slip});
                kinds.push_back({steps, weight, slip, 1.2});
            }
        }
    }
    return kinds;
}

}  // namespace

TEST_CASE("no path costs less than the one found") {
    for (const WarpOptions& options : every_kind()) {
        for (const auto& [n, m] : {std::pair{1, 1}, {1, 2}, {3, 1}, {4, 4}, {6, 5}, {3, 6}}) {
            const MatrixF first = wandering(n, 3, uint64_t(n)), second = wandering(m, 3, 90);
            const EveryPath every(first, second, options);
            const WarpPath path = warp(first, second, options);
            CHECK(path.cells.empty() == (every.least_total == infinite));
            CHECK(path.total == every.least_total);
            CHECK(std::ranges::count(every.cheapest, path.cells) == !path.cells.empty());
            CHECK(warp_cost(first, second, options) == path.mean);
            if (path.cells.empty()) continue;
            CHECK(path.mean == Approx(path.total / every.weights).epsilon(1e-12));
        }
    }
}

TEST_CASE("distances that are given lead to the same path as the rows they are of") {
    for (const WarpOptions& options : every_kind()) {
        const MatrixF first = wandering(7, 3, 1), second = wandering(9, 3, 2);
        MatrixD distances(7, 9);
        for (int64_t i = 0; i < 7; ++i) {
            for (int64_t j = 0; j < 9; ++j) distances(i, j) = distance(first, i, second, j);
        }
        const WarpPath expected = warp(first, second, options), path = warp(distances, options);
        CHECK(path.cells == expected.cells);
        CHECK(path.total == expected.total);
        CHECK(path.mean == expected.mean);
    }
    CHECK(warp(MatrixD(0, 3)).cells.empty());
}

TEST_CASE("giving up early leaves out only what costs more than the bound") {
    int64_t found = 0, given_up = 0;
    for (const WarpOptions& options : every_kind()) {
        for (uint64_t seed = 0; seed < 20; ++seed) {
            const MatrixF first = wandering(20, 4, seed), second = wandering(24, 4, seed + 40);
            const double cost = warp_cost(first, second, options);
            if (cost == infinite) continue;
            for (const double share : {0.5, 0.9, 1 - 1e-15, 1.0, 1.1}) {
                const double bounded = warp_cost(first, second, options, share * cost);
                const bool within = cost <= share * cost;
                CHECK(bounded == (within ? cost : infinite));
                ++(within ? found : given_up);
            }
        }
    }
    CHECK(found > 100);
    CHECK(given_up > 100);
}

TEST_CASE("a sequence warped in time costs little, and the path tells how it was warped") {
    const MatrixF first = wandering(60, 5, 7);
    MatrixF second(90, 5);  // the first half at half the speed
    for (int64_t j = 0; j < 90; ++j) second.row(j) = first.row(j < 60 ? j / 2 : j - 30);
    const WarpPath path = warp(first, second, {unlimited_steps()});
    CHECK(path.total == 0);
    for (const WarpCell& cell : path.cells) {
        CHECK(cell.first == (cell.second < 60 ? cell.second / 2 : cell.second - 30));
    }
    CHECK(warp(first, first, {unlimited_steps()}).cells.size() == 60);
    CHECK(warp_cost(first, second, {}) < 0.2 * warp_cost(first, wandering(90, 5, 8), {}));
}

TEST_CASE("slope-limited paths join lengths up to twice each other, and slips a frame more") {
    const MatrixF long_one = wandering(21, 2, 1);
    CHECK(warp(long_one, wandering(11, 2, 2)).cells.size() == 11);
    CHECK(warp(long_one, wandering(10, 2, 2)).cells.empty());
    CHECK(warp_cost(long_one, wandering(10, 2, 2), {}) == infinite);
    CHECK(warp(long_one, wandering(10, 2, 2), {slope_limited_steps(), WarpWeight::both, 1})
              .cells.size() == 10);
}

TEST_CASE("a cost does not depend on which sequence comes first") {
    const MatrixF first = wandering(30, 6, 1), second = wandering(41, 6, 2);
    for (const int64_t slip : {0, 1}) {
        const WarpOptions options{slope_limited_steps(), WarpWeight::both, slip};
        CHECK(warp_cost(first, second, options) == warp_cost(second, first, options));
    }
}

TEST_CASE("sequences without rows have no path, and all-equal rows cost nothing") {
    const MatrixF none(0, 3), some = MatrixF::Constant(9, 3, 4.5F);
    CHECK(warp(none, some).cells.empty());
    CHECK(warp(some, none).mean == infinite);
    CHECK(warp_cost(none, none, {}) == infinite);
    CHECK(warp_matches(none, some, {}).empty());
    CHECK(warp_matches(some, none, {}).empty());
    CHECK(warp(some, some).mean == 0);
    CHECK(warp(some, some).cells.size() == 9);
}

TEST_CASE("a path through a value that is not a number is not found") {
    MatrixF broken = wandering(9, 3, 1);
    broken(4, 1) = std::nanf("");
    CHECK(warp(broken, wandering(9, 3, 1), {{{1, 1}}}).cells.empty());
    broken(4, 1) = std::numeric_limits<float>::infinity();
    CHECK(warp_cost(broken, wandering(9, 3, 1), {{{1, 1}}}) == infinite);
}

TEST_CASE("sequences that do not fit and steps that lead nowhere are refused") {
    const MatrixF rows = wandering(4, 3, 1);
    CHECK_THROWS_AS(warp(rows, wandering(4, 2, 1)), std::invalid_argument);
    CHECK_THROWS_AS(warp(rows, rows, {{{0, 0}}}), std::invalid_argument);
    CHECK_THROWS_AS(warp(rows, rows, {{{1, -1}}}), std::invalid_argument);
    CHECK_THROWS_AS(warp(rows, rows, {std::vector<WarpStep>{}}), std::invalid_argument);
    CHECK_THROWS_AS(warp_cost(rows, rows, {slope_limited_steps(), WarpWeight::both, -1}),
                    std::invalid_argument);
    CHECK_THROWS_AS(warp_matches(rows, rows, {1, unlimited_steps()}), std::invalid_argument);
}

TEST_CASE("a query is found wherever it was hidden, at its own speed and at another") {
    const MatrixF query = wandering(20, 6, 5);
    MatrixF sequence = wandering(300, 6, 6).array() + 9.0F;
    sequence.middleRows(40, 20) = query;
    for (int64_t j = 0; j < 39; ++j) sequence.row(150 + j) = query.row((j + 1) / 2);
    const auto matches = warp_matches(query, sequence, {0.2});
    REQUIRE(matches.size() == 2);
    CHECK(matches[0].mean == 0);
    CHECK(matches[0].cells.front() == WarpCell{0, 40});
    CHECK(matches[0].cells.back() == WarpCell{19, 59});
    CHECK(matches[1].cells.front().second == Approx(150).margin(1));
    CHECK(matches[1].cells.back().second == Approx(188).margin(1));
}

TEST_CASE("matches are the best windows of all, none overlapping a better one") {
    const MatrixF query = wandering(6, 2, 3), sequence = wandering(60, 2, 4);
    const WarpOptions options{slope_limited_steps(), WarpWeight::first, 0};
    const double at_most = 2.0;
    // For each end the best of all windows, longer ones first where they cost the same.
    std::vector<std::tuple<double, int64_t, int64_t>> windows;
    for (int64_t end = 1; end <= 60; ++end) {
        std::tuple<double, int64_t, int64_t> best{infinite, end, 0};
        for (int64_t begin = 0; begin < end; ++begin) {
            const double mean = warp_cost(query, sequence.middleRows(begin, end - begin), options);
            best = std::min(best, {mean, end, begin});
        }
        if (std::get<0>(best) <= at_most) windows.push_back(best);
    }
    std::sort(windows.begin(), windows.end());
    std::vector<std::tuple<int64_t, int64_t, double>> expected;
    for (const auto& [mean, end, begin] : windows) {
        const bool overlaps = std::any_of(expected.begin(), expected.end(), [&](const auto& taken) {
            return begin < std::get<1>(taken) && std::get<0>(taken) < end;
        });
        if (!overlaps) expected.emplace_back(begin, end, mean);
    }
    std::sort(expected.begin(), expected.end());
    REQUIRE(expected.size() > 2);
    REQUIRE(expected.size() < windows.size());

    const auto matches = warp_matches(query, sequence, {at_most});
    REQUIRE(matches.size() == expected.size());
    for (size_t i = 0; i < matches.size(); ++i) {
        const auto& [begin, end, mean] = expected[i];
        CHECK(matches[i].cells.front() == WarpCell{0, int32_t(begin)});
        CHECK(matches[i].cells.back() == WarpCell{5, int32_t(end - 1)});
        CHECK(matches[i].mean == mean);
    }
}
