#include "kinetome/math/knn.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "../../src/math/knn_axes.h"
#include "mixture_reference.h"

using namespace kinetome;
using namespace kinetome::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Every row for every query, by comparing each pair.
class AllPairs {
  public:
    AllPairs(const MatrixF& rows, const MatrixF& queries) {
        for (int64_t q = 0; q < queries.rows(); ++q) {
            auto& found = found_.emplace_back();
            for (int64_t i = 0; i < rows.rows(); ++i)
                found.emplace_back(squared_distance(queries, q, rows, i), int32_t(i));
            std::sort(found.begin(), found.end());
        }
    }
    NeighbourLists lists(const KnnOptions& options,
                         const std::vector<RowRange>& excluded = {}) const {
        NeighbourLists lists;
        for (size_t q = 0; q < found_.size(); ++q) {
            const RowRange left_out = excluded.empty() ? RowRange{} : excluded[q];
            const int64_t most = lists.offsets.back() + options.neighbours;
            for (const auto& [squared, row] : found_[q]) {
                if (squared > options.radius * options.radius) break;
                if (row >= left_out.first && row < left_out.end) continue;
                if (int64_t(lists.rows.size()) == most) break;
                lists.rows.push_back(row);
                lists.distances.push_back(static_cast<float>(std::sqrt(squared)));
            }
            lists.offsets.push_back(int64_t(lists.rows.size()));
        }
        return lists;
    }

  private:
    std::vector<std::vector<std::pair<double, int32_t>>> found_;
};

bool same(const NeighbourLists& a, const NeighbourLists& b) {
    return a.offsets == b.offsets && a.rows == b.rows && a.distances == b.distances;
}

NeighbourLists block_lists(const MatrixF& rows, const MatrixF& queries, const KnnOptions& options,
                           const std::vector<RowRange>& excluded = {}) {
    return KnnIndex(rows, KnnEngine::blocks, 1).search(queries, options, 1, excluded);
}

/// Corners of a grid: nearly all distances have ties.
MatrixF grid_rows(int64_t count, int64_t dimension, uint64_t seed) {
    RandomStream random(seed, "grid rows");
    MatrixF rows(count, dimension);
    for (int64_t i = 0; i < rows.size(); ++i) rows.data()[i] = float(random.below(3));
    return rows;
}

MatrixF shuffled(const MatrixF& rows, uint64_t seed) {
    RandomStream random(seed, "shuffled rows");
    MatrixF other = rows;
    for (int64_t i = rows.rows() - 1; i > 0; --i)
        other.row(i).swap(other.row(int64_t(random.below(uint64_t(i + 1)))));
    return other;
}

struct Case {
    std::string name;
    MatrixF rows;
};

/// Rows that each have a way of their own of going wrong.
std::vector<Case> all_cases(int64_t dimension) {
    const MatrixF moving = wandering_rows(300, dimension, 1);
    std::vector<Case> cases = {{"moving", moving},
                               {"shuffled", shuffled(moving, 2)},
                               {"scattered", scattered_rows(250, dimension, 3)},
                               {"grid", grid_rows(300, dimension, 4)},
                               {"all equal", MatrixF::Constant(250, dimension, 0.1F)},
                               {"far from the origin", moving.array() + 3e6F},
                               {"tiny", moving * 1e-30F},
                               {"huge", moving * 1e30F},
                               {"one row", moving.topRows(1)},
                               {"fewer rows than neighbours", moving.topRows(13)}};
    MatrixF held = moving;
    for (int64_t i = 0; i < held.rows(); ++i) held.row(i) = moving.row(i / 25 % 3);
    cases.push_back({"held still, the same three poses again", held});
    MatrixF outlier = moving;
    outlier.row(133).setConstant(1e25F);
    cases.push_back({"one row far from all", outlier});
    MatrixF crowds = moving * 100;
    for (int64_t i = 0; i < crowds.rows(); ++i) crowds.row(i).array() += i % 16 < 8 ? 3e7F : -3e7F;
    cases.push_back({"two crowds, each finer than float tells from their middle", crowds});
    MatrixF flat = moving;
    flat.rightCols(dimension / 2).setConstant(7);
    cases.push_back({"columns without variance", flat});
    return cases;
}

/// A radius that holds about a tenth of the rows, and is met exactly where the square allows.
double middling_radius(const MatrixF& rows) {
    std::vector<double> distances;
    for (int64_t i = 0; i < rows.rows(); ++i)
        distances.push_back(std::sqrt(squared_distance(rows, rows.rows() / 2, rows, i)));
    std::sort(distances.begin(), distances.end());
    return distances[distances.size() / 10];
}

}  // namespace

TEST_CASE("the block search finds what comparing every pair finds, whatever the rows") {
    const int64_t dimension = GENERATE(1, 2, 7, 8, 15, 45, 64);
    for (const auto& [name, rows] : all_cases(dimension)) {
        const KnnIndex index(rows, KnnEngine::blocks, 1);
        const AllPairs pairs(rows, rows);
        for (const double radius : {0.0, middling_radius(rows), infinity}) {
            for (const int64_t most : {1, 16, 2000}) {
                INFO(name << ", " << dimension << " columns, radius " << radius << ", " << most
                          << " neighbours");
                const KnnOptions options{radius, most};
                CHECK(same(index.search(rows, options, 1), pairs.lists(options)));
            }
        }
    }
}

TEST_CASE("queries need not be among the rows") {
    const MatrixF rows = wandering_rows(900, 12, 1);
    const KnnOptions options{4, 20};
    for (const MatrixF& queries : {wandering_rows(101, 12, 2), scattered_rows(50, 12, 3),
                                   MatrixF(scattered_rows(9, 12, 3).array() + 1e30F)}) {
        CHECK(same(block_lists(rows, queries, options), AllPairs(rows, queries).lists(options)));
    }
}

TEST_CASE("a radius holds the rows that lie on it") {
    MatrixF rows(4, 2);
    rows << 0, 0, 3, 4, 30, 40, 5.000001F, 0;
    const KnnEngine engine = GENERATE(KnnEngine::blocks, KnnEngine::flann);
    const NeighbourLists lists = KnnIndex(rows, engine, 1).search(rows.topRows(1), {5, 10}, 1);
    CHECK(lists.rows == std::vector<int32_t>{0, 1});
    CHECK(lists.distances == std::vector<float>{0, 5});
}

TEST_CASE("of equally near rows the first ones are listed") {
    MatrixF rows = MatrixF::Constant(5000, 6, 2.5F);
    rows.row(1).setConstant(9);
    const NeighbourLists lists = block_lists(rows, rows.middleRows(4000, 3), {1, 4});
    for (int64_t q = 0; q < 3; ++q) {
        const auto found = lists.rows_of(q);
        CHECK(std::vector(found.begin(), found.end()) == std::vector<int32_t>{0, 2, 3, 4});
    }
}

TEST_CASE("lists do not depend on threads or on which queries are asked together") {
    const MatrixF rows = wandering_rows(3000, 15, 5);
    const KnnOptions options{3, 32};
    const NeighbourLists whole = block_lists(rows, rows, options);
    for (const int threads : {2, 3, 7}) {
        const KnnIndex index(rows, KnnEngine::blocks, threads);
        CHECK(same(index.search(rows, options, threads), whole));
    }
    const KnnIndex index(rows, KnnEngine::blocks, 1);
    NeighbourLists joined;
    const int64_t cuts[] = {0, 1, 6, 300, 301, 1777, 3000};
    for (size_t i = 1; i < std::size(cuts); ++i) {
        const NeighbourLists part =
            index.search(rows.middleRows(cuts[i - 1], cuts[i] - cuts[i - 1]), options, 2);
        const int64_t before = joined.offsets.back();
        for (size_t q = 1; q < part.offsets.size(); ++q)
            joined.offsets.push_back(before + part.offsets[q]);
        joined.rows.insert(joined.rows.end(), part.rows.begin(), part.rows.end());
        joined.distances.insert(joined.distances.end(), part.distances.begin(),
                                part.distances.end());
    }
    CHECK(same(joined, whole));
}

TEST_CASE("rows of a view are read where they lie") {
    const MatrixF rows = wandering_rows(400, 20, 6);
    const KnnOptions options{3, 16};
    const MatrixF copy = rows.block(50, 3, 300, 9);
    const NeighbourLists expected = AllPairs(copy, copy).lists(options);
    const KnnIndex index(rows.block(50, 3, 300, 9), KnnEngine::blocks, 1);
    CHECK(same(index.search(rows.block(50, 3, 300, 9), options, 1), expected));
}

TEST_CASE("excluded rows make room for others") {
    const MatrixF rows = wandering_rows(800, 9, 7);
    const std::vector<int64_t> clips = {0, 3, 250, 251, 800};
    const int64_t frames = GENERATE(0, 1, 5, 60, 1000);
    const std::vector<RowRange> nearby = rows_nearby_in_time(clips, {0, 800}, frames);
    const KnnOptions options{2.5, 24};
    const NeighbourLists expected = AllPairs(rows, rows).lists(options, nearby);
    CHECK(same(block_lists(rows, rows, options, nearby), expected));
    const KnnIndex flann(rows, KnnEngine::flann, 1);
    CHECK(flann.search(rows, options, 1, nearby).offsets == expected.offsets);
}

/// What search_more over parts finds, parts cut at `cuts` and searched in the order given.
ListsOfWhole lists_of_parts(const MatrixF& rows, const KnnOptions& options,
                            const std::vector<int64_t>& cuts, const std::vector<size_t>& order,
                            const std::vector<RowRange>& excluded, int threads) {
    const auto count = size_t(rows.rows());
    ListsOfWhole whole{options.neighbours, std::vector(count, options.radius), {}};
    whole.lists.resize(count);
    for (const size_t part : order) {
        const int64_t first = cuts[part], size = cuts[part + 1] - first;
        std::vector<RowRange> of_part;
        for (const RowRange& range : excluded) {
            of_part.push_back({range.first - first, range.end - first});
        }
        KnnIndex(rows.middleRows(first, size), KnnEngine::blocks, threads)
            .search_more(rows, first, whole, threads, of_part);
    }
    return whole;
}

bool same(const ListsOfWhole& whole, const NeighbourLists& expected) {
    NeighbourLists lists;
    for (const auto& list : whole.lists) {
        for (const RowOfWhole& one : list) {
            lists.rows.push_back(int32_t(one.row));
            lists.distances.push_back(float(std::sqrt(one.squared)));
        }
        lists.offsets.push_back(int64_t(lists.rows.size()));
    }
    return same(lists, expected);
}

TEST_CASE(
    "part by part, in any order, the lists are those of the whole, ties at the end included") {
    for (const auto& [name, rows] : all_cases(9)) {
        if (rows.rows() < 200) continue;
        const int64_t count = rows.rows();
        const auto clips = std::vector<int64_t>{0, 60, count};
        for (const int64_t most : {1, 10, 1000}) {
            for (const int64_t apart : {0, 12}) {
                const KnnOptions options{middling_radius(rows), most};
                const auto excluded = rows_nearby_in_time(clips, {0, count}, apart);
                const NeighbourLists expected = block_lists(rows, rows, options, excluded);
                const std::vector<int64_t> cuts = {0, 1, 70, 71, 160, count};
                INFO(name << ", " << most << " neighbours, " << apart << " frames excluded");
                CHECK(same(lists_of_parts(rows, options, cuts, {0, 1, 2, 3, 4}, excluded, 1),
                           expected));
                CHECK(same(lists_of_parts(rows, options, cuts, {3, 0, 4, 2, 1}, excluded, 2),
                           expected));
                CHECK(same(lists_of_parts(rows, options, {0, count}, {0}, excluded, 1), expected));
            }
        }
    }
}

TEST_CASE("each query has a radius of its own when parts are searched") {
    const MatrixF rows = wandering_rows(300, 6, 21);
    const KnnIndex index(rows, KnnEngine::blocks, 1);
    ListsOfWhole whole{50, {}, std::vector<std::vector<RowOfWhole>>(300)};
    for (int64_t q = 0; q < 300; ++q) whole.radii.push_back(q % 2 ? 1.0 : 3.0);
    index.search_more(rows, 1000, whole, 1);
    const NeighbourLists near = index.search(rows, {1, 50}, 1),
                         far = index.search(rows, {3, 50}, 1);
    for (int64_t q = 0; q < 300; ++q) {
        const auto expected = (q % 2 ? near : far).rows_of(q);
        const auto& found = whole.lists[size_t(q)];
        REQUIRE(found.size() == expected.size());
        for (size_t i = 0; i < found.size(); ++i) CHECK(found[i].row == 1000 + expected[i]);
    }
    whole.radii.pop_back();
    CHECK_THROWS_AS(index.search_more(rows, 0, whole, 1), std::invalid_argument);
}

TEST_CASE("frames nearby in time are those of the same clip") {
    const std::vector<int64_t> clips = {0, 10, 10, 30};
    const auto nearby = rows_nearby_in_time(clips, {8, 13}, 3);
    CHECK(nearby == std::vector<RowRange>{{6, 10}, {7, 10}, {10, 13}, {10, 14}, {10, 15}});
    CHECK(rows_nearby_in_time(clips, {5, 6}, 1) == std::vector<RowRange>{{5, 6}});
    CHECK(rows_nearby_in_time(clips, {5, 6}, 0).front().size() <= 0);
    CHECK_THROWS_WITH(rows_nearby_in_time(clips, {29, 31}, 3), Catch::Contains("row 30"));
}

TEST_CASE("FLANN finds the same distances, and the same rows below the last") {
    const int64_t dimension = GENERATE(1, 3, 45);
    const MatrixF rows =
        GENERATE_COPY(wandering_rows(1500, dimension, 8), scattered_rows(500, dimension, 9),
                      grid_rows(500, dimension, 10));
    for (const int64_t most : {1, 16, 2000}) {
        const KnnOptions options{middling_radius(rows) + 1e-3, most};
        const NeighbourLists ours = block_lists(rows, rows, options);
        const NeighbourLists theirs = KnnIndex(rows, KnnEngine::flann, 1).search(rows, options, 2);
        REQUIRE(theirs.offsets == ours.offsets);
        for (int64_t q = 0; q < rows.rows(); ++q) {
            const auto distances = ours.distances_of(q), other = theirs.distances_of(q);
            std::vector<int32_t> found, expected;
            for (size_t i = 0; i < distances.size(); ++i) {
                CHECK(std::abs(other[i] - distances[i]) <= 1e-5F * (1 + distances[i]));
                const float last = distances.back() * (1 - 1e-5F);
                if (distances[i] < last) expected.push_back(ours.rows_of(q)[i]);
                if (other[i] < last) found.push_back(theirs.rows_of(q)[i]);
            }
            std::sort(found.begin(), found.end());
            std::sort(expected.begin(), expected.end());
            CHECK(found == expected);
        }
    }
}

TEST_CASE("projected rows are never farther apart than the rows, but for the slack") {
    for (const auto& [name, rows] : all_cases(24)) {
        INFO(name);
        const LeadingAxes axes(rows);
        MatrixF projected;
        VectorF slack;
        axes.project(rows, projected, slack);
        for (int64_t i = 0; i < rows.rows(); i += 3) {
            for (int64_t j = 0; j < rows.rows(); j += 7) {
                const double between = std::sqrt(squared_distance(rows, i, rows, j));
                const double apart = std::sqrt(squared_distance(projected, i, projected, j));
                CHECK(apart <= between * (1 + 1e-12) + double(slack[i]) + double(slack[j]));
            }
        }
    }
}

TEST_CASE("neighbours of a value that is not finite are refused, naming its row") {
    const KnnEngine engine = GENERATE(KnnEngine::blocks, KnnEngine::flann);
    const float value =
        GENERATE(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity());
    const MatrixF rows = wandering_rows(40, 3, 11);
    MatrixF broken = rows;
    broken(17, 2) = value;
    CHECK_THROWS_WITH(KnnIndex(broken, engine, 1), Catch::Contains("row 17"));
    CHECK_THROWS_WITH(KnnIndex(rows, engine, 1).search(broken, {1, 3}, 1),
                      Catch::Contains("row 17"));
}

TEST_CASE("what makes no sense is refused") {
    const MatrixF rows = wandering_rows(40, 3, 12);
    const KnnIndex index(rows, KnnEngine::blocks, 1);
    CHECK_THROWS_AS(KnnIndex(MatrixF(3, 0), KnnEngine::blocks, 1), std::invalid_argument);
    CHECK_THROWS_AS(index.search(rows.leftCols(2), {1, 3}, 1), std::invalid_argument);
    CHECK_THROWS_AS(index.search(rows, {-1, 3}, 1), std::invalid_argument);
    CHECK_THROWS_AS(index.search(rows, {std::nan(""), 3}, 1), std::invalid_argument);
    CHECK_THROWS_AS(index.search(rows, {1, 0}, 1), std::invalid_argument);
    const std::vector<RowRange> too_few(39);
    CHECK_THROWS_AS(index.search(rows, {1, 3}, 1, too_few), std::invalid_argument);
}

TEST_CASE("without rows nothing is found, without queries nothing is asked") {
    const KnnEngine engine = GENERATE(KnnEngine::blocks, KnnEngine::flann);
    const MatrixF some = wandering_rows(20, 4, 13), none(0, 4);
    const NeighbourLists of_none = KnnIndex(none, engine, 1).search(some, {1, 3}, 1);
    CHECK(of_none.queries() == 20);
    CHECK(of_none.rows.empty());
    CHECK(KnnIndex(some, engine, 1).search(none, {1, 3}, 1).queries() == 0);
}
