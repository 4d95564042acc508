#include "kinetome/models/hierarchy_growth.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <map>
#include <set>

#include "kinetome/math/symmetric_eigen.h"
#include "support/thread_ranks.h"
#include "toy_poses.h"

using namespace kinetome;

namespace {

using Columns = std::vector<int32_t>;

struct Growth {
    PoseHierarchyOptions options;
    int threads = 1;
    int64_t nodes_per_pass = 100;
    Communicator* ranks = nullptr;
    GrowthCheckpoints checkpoints = {};

    GrownHierarchy operator()(const MatrixF& poses, const Columns& principal_columns) const {
        const MatrixF principal = columns_of(poses, principal_columns);
        return grow_pose_hierarchy(MatrixRows(poses), MatrixRows(principal), principal_columns,
                                   options, Workers(threads, ranks), nodes_per_pass, {},
                                   checkpoints);
    }
};

/// All there is of a model, as bytes.
std::string bytes_of(const GrownHierarchy& grown) {
    std::string bytes = packed(grown.hierarchy);
    for (const MatrixD& map : grown.maps.maps) bytes += packed(map);
    return bytes;
}

double worst_error(const PoseHierarchy& hierarchy, const MatrixF& poses) {
    return std::ranges::max(leaf_errors(hierarchy, poses, leaves_of(hierarchy, poses)));
}

/// The method as the paper tells it, one node after the other, all in memory: the sets of rows of
/// the leaves.
void divide(const MatrixD& poses, const Columns& principal, const PoseHierarchyOptions& options,
            std::vector<int64_t> rows, std::set<std::vector<int64_t>>& leaves) {
    MatrixD own(static_cast<int64_t>(rows.size()), poses.cols());
    for (size_t i = 0; i < rows.size(); ++i) own.row(int64_t(i)) = poses.row(rows[i]);
    const Eigen::RowVectorXd mean = own.colwise().mean();
    const MatrixD centred = own.rowwise() - mean;
    const MatrixD covariance = centred.transpose() * centred / double(rows.size());
    const VectorD variances = symmetric_eigenvalues(covariance);
    const double left = std::max(variances.tail(variances.size() - options.dimension).sum(), 0.0);
    if (10 * std::sqrt(left / double(compared_markers(poses.cols()))) <= options.leaf_tolerance) {
        leaves.insert(rows);
        return;
    }
    const MatrixD values = own(Eigen::all, principal);
    VectorD normal = symmetric_eigen(covariance(principal, principal)).vectors.col(0);
    make_largest_entry_positive(normal);
    double offset = values.colwise().mean().dot(normal);
    std::vector<int64_t> below, above;
    for (int iteration = 0; iteration < options.split_iterations; ++iteration) {
        below.clear();
        above.clear();
        VectorD low = VectorD::Zero(values.cols()), high = low;
        for (size_t i = 0; i < rows.size(); ++i) {
            const VectorD value = values.row(int64_t(i));
            const bool is_above = value.dot(normal) > offset;
            (is_above ? above : below).push_back(rows[i]);
            (is_above ? high : low) += value;
        }
        high /= double(above.size());
        low /= double(below.size());
        normal = (high - low).normalized();
        offset = normal.dot(high + low) / 2;
    }
    divide(poses, principal, options, below, leaves);
    divide(poses, principal, options, above, leaves);
}

/// Rows of each leaf, by the classifier.
std::set<std::vector<int64_t>> members(const PoseHierarchy& hierarchy, const MatrixF& poses) {
    std::map<int32_t, std::vector<int64_t>> rows;
    const auto leaves = leaves_of(hierarchy, poses);
    for (size_t i = 0; i < leaves.size(); ++i) rows[leaves[i]].push_back(int64_t(i));
    std::set<std::vector<int64_t>> sets;
    for (auto& [leaf, of_leaf] : rows) sets.insert(std::move(of_leaf));
    return sets;
}

const Columns some_columns{3, 7, 11};

PoseHierarchyOptions fine() {
    PoseHierarchyOptions options;
    options.dimension = 2;
    options.leaf_tolerance = 40;
    return options;
}

}  // namespace

TEST_CASE("growth by levels divides poses as the paper's recursion does") {
    const MatrixF poses = swinging_poses(3000);
    PoseHierarchyOptions options = fine();
    options.leaf_tolerance = 70;
    options.split_iterations = 8;
    std::vector<int64_t> all(3000);
    for (size_t i = 0; i < all.size(); ++i) all[i] = int64_t(i);
    std::set<std::vector<int64_t>> expected;
    divide(poses.cast<double>(), some_columns, options, all, expected);
    const auto grown = Growth{options}(poses, some_columns);
    REQUIRE(expected.size() > 20);
    CHECK(grown.hierarchy.leaves() == int64_t(expected.size()));
    CHECK(members(grown.hierarchy, poses) == expected);
}

TEST_CASE("each leaf of poses on two lines is one of the lines") {
    MatrixF poses = MatrixF::Zero(400, 6);
    for (int64_t i = 0; i < 400; ++i) {
        const auto along = static_cast<float>(i / 2) / 10;
        poses.row(i).tail(3) << (i % 2 ? 30.F : -30.F), (i % 2 ? along : 0.F),
            (i % 2 ? 0.F : along);
    }
    PoseHierarchyOptions options;
    options.dimension = 1;
    options.leaf_tolerance = 1;
    const auto grown = Growth{options}(poses, {3, 4, 5});
    const PoseHierarchy& hierarchy = grown.hierarchy;
    REQUIRE(hierarchy.leaves() == 2);
    CHECK(hierarchy.means(0, 3) == Approx(-30));
    CHECK(std::abs(hierarchy.basis(0)(5, 0)) == Approx(1));
    CHECK(std::abs(hierarchy.basis(1)(4, 0)) == Approx(1));
    CHECK(hierarchy.leaf_errors.maxCoeff() < 1e-3);
    // Between (-30, 0, 9.95) and (30, 9.95, 0), the means of the lines.
    CHECK(hierarchy.nodes[0].half_gap == Approx(std::hypot(60, 9.95, 9.95) / 2));
    CHECK(std::abs(hierarchy.normals(0, 0)) == Approx(60 / std::hypot(60, 9.95, 9.95)));
    CHECK(hierarchy.nodes[0].rows == 400);
}

TEST_CASE("a hierarchy is the same for any threads, ranks, passes, and resumed from any level") {
    const MatrixF poses = swinging_poses(7000);
    Growth growth{fine()};
    growth.options.leaf_tolerance = 90;
    growth.options.overlap = 0.2;
    std::vector<std::string> saved;
    growth.checkpoints.save = [&](int, const HierarchyLevel& level) {
        saved.push_back(packed(level));
    };
    const std::string expected = bytes_of(growth(poses, some_columns));
    growth.checkpoints = {};
    REQUIRE(saved.size() > 4);

    growth.nodes_per_pass = 7;
    growth.threads = 2;
    CHECK(bytes_of(growth(poses, some_columns)) == expected);
    for (const int ranks : {2, 3}) {
        std::vector<std::string> found(static_cast<size_t>(ranks));
        run_as_ranks(ranks, [&](Communicator& rank) {
            Growth own = growth;
            own.ranks = &rank;
            found[static_cast<size_t>(rank.rank())] = bytes_of(own(poses, some_columns));
        });
        for (const std::string& one : found) CHECK(one == expected);
    }
    for (const size_t done : {size_t{1}, size_t{3}, saved.size()}) {
        growth.checkpoints.load = [&](int level) -> std::optional<HierarchyLevel> {
            if (static_cast<size_t>(level) >= done) return std::nullopt;
            return unpacked<HierarchyLevel>(saved[static_cast<size_t>(level)]);
        };
        CHECK(bytes_of(growth(poses, some_columns)) == expected);
    }
}

TEST_CASE("the maximum rule leaves no pose beyond the tolerance, RMS some") {
    const MatrixF poses = swinging_poses(3000);
    Growth growth{fine()};
    const auto by_rms = growth(poses, some_columns);
    growth.options.leaf_rule = LeafRule::maximum;
    const auto by_maximum = growth(poses, some_columns);
    const auto largest = [&](const GrownHierarchy& grown) {
        return worst_error(grown.hierarchy, poses);
    };
    CHECK(by_rms.hierarchy.leaf_errors.maxCoeff() <= 40);
    CHECK(largest(by_rms) > 40);
    CHECK(largest(by_maximum) <= 40);
    CHECK(by_maximum.hierarchy.leaves() > by_rms.hierarchy.leaves());
}

TEST_CASE("poses near a plane are in both children, copies once, and not nearly all of them") {
    const MatrixF poses = swinging_poses(3000);
    Growth growth{fine()};
    growth.options.overlap = 0.3;
    const auto rows_of_leaves = [](const GrownHierarchy& grown) {
        int64_t rows = 0;
        for (const HierarchyNode& node : grown.hierarchy.nodes) rows += node.is_leaf() * node.rows;
        return rows;
    };
    const auto grown = growth(poses, some_columns);
    CHECK(rows_of_leaves(grown) > 3300);
    const auto& nodes = grown.hierarchy.nodes;
    for (const HierarchyNode& node : nodes) {
        if (node.is_leaf()) continue;
        const int64_t below = nodes[size_t(node.below)].rows,
                      above = nodes[size_t(node.above)].rows;
        CHECK(below + above >= node.rows);
        if (below + above > node.rows)
            CHECK(double(std::max(below, above)) <= 0.9 * double(node.rows));
    }

    growth.options.overlap = 100;  // everything lies in the band: no node may be divided like that
    CHECK(rows_of_leaves(growth(poses, some_columns)) == 3000);
}

TEST_CASE("degenerate poses make a model without a value that is not a number") {
    const auto check_sound = [](const MatrixF& poses, const Columns& principal) {
        for (const auto rule : {MarkerMapRule::shrinkage, MarkerMapRule::least_squares}) {
            Growth growth;
            growth.options.maps.rule = rule;
            growth.options.leaf_rule = LeafRule::maximum;
            const auto grown = growth(poses, principal);
            CHECK(grown.hierarchy.means.allFinite());
            CHECK(grown.hierarchy.bases.allFinite());
            CHECK(grown.hierarchy.leaf_errors.allFinite());
            for (const MatrixD& map : grown.maps.maps) CHECK(map.allFinite());
            CHECK(worst_error(grown.hierarchy, poses) < 1e-3);
        }
    };
    const MatrixF poses = swinging_poses(40);
    check_sound(poses.topRows(1), some_columns);
    check_sound(poses.topRows(3), some_columns);               // fewer than d
    check_sound(poses.row(5).replicate(30, 1), some_columns);  // all equal
    check_sound(poses.row(5).replicate(30, 1), {});  // nothing moves: no principal markers
    MatrixF pairs(30, 18);
    for (int64_t i = 0; i < 30; ++i) pairs.row(i) = poses.row(i % 2 ? 0 : 39);
    check_sound(pairs, some_columns);
}

TEST_CASE("poses that differ where no principal marker tells stay together") {
    MatrixF poses = swinging_poses(3000);
    for (const int32_t column : some_columns) poses.col(column).setConstant(1);
    const auto grown = Growth{fine()}(poses, some_columns);
    CHECK(grown.hierarchy.leaves() == 1);
    CHECK(grown.hierarchy.leaf_errors[0] > 60);
}

TEST_CASE("a value that is not finite is named") {
    MatrixF poses = swinging_poses(5000);
    poses(4321, 8) = std::numeric_limits<float>::quiet_NaN();
    CHECK_THROWS_WITH((Growth{fine()}(poses, some_columns)),
                      Catch::Contains("pose 4321") && Catch::Contains("column 8"));
    CHECK_THROWS_AS((Growth{fine()}(MatrixF(0, 18), some_columns)), std::invalid_argument);
}
