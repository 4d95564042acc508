#include "kinetome/models/estimation_score.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

#include "toy_poses.h"

using namespace kinetome;

namespace {

std::vector<int64_t> rows_held_out(const std::vector<RowRange>& takes,
                                   const HeldOutOptions& options) {
    const auto held = held_out(takes, 10, options);
    std::vector<int64_t> rows;
    for (size_t i = 0; i < held.size(); ++i) {
        if (held[i]) rows.push_back(static_cast<int64_t>(i));
    }
    CHECK(int64_t(held.size()) == takes.back().end);
    return rows;
}

}  // namespace

TEST_CASE("whole takes, blocks of takes or single frames are held out") {
    const std::vector<RowRange> takes{{0, 5}, {5, 12}, {12, 15}, {15, 30}};
    HeldOutOptions options{.what = HeldOut::takes, .every_take = 2};
    CHECK(rows_held_out(takes, options) == std::vector<int64_t>{5,  6,  7,  8,  9,  10, 11, 15,
                                                                16, 17, 18, 19, 20, 21, 22, 23,
                                                                24, 25, 26, 27, 28, 29});
    options = {.what = HeldOut::blocks, .block_seconds = 0.4, .every_block = 3};
    // Blocks: 0-4 4-5 | 5-9* 9-12 | 12-15 | 15-19* 19-23 23-27 27-30*.
    CHECK(rows_held_out(takes, options) ==
          std::vector<int64_t>{5, 6, 7, 8, 15, 16, 17, 18, 27, 28, 29});
    options = {.what = HeldOut::frames};
    const std::vector<RowRange> long_take{{0, 5000}};
    const auto drawn = rows_held_out(long_take, options);
    CHECK(drawn.size() > 900);
    CHECK(drawn.size() < 1100);
    CHECK(rows_held_out(long_take, options) == drawn);
}

TEST_CASE("the error is over estimated markers alone") {
    PrincipalMarkers principal;
    principal.markers = {1};
    CHECK(estimated_markers(principal, 12) == 2);
    const std::vector<float> pose(12, 1.F);
    VectorD estimate = VectorD::Ones(12);
    estimate[6] = 2;
    CHECK(estimation_error(pose, estimate, 2) == Approx(10 / std::sqrt(2)));
}

TEST_CASE("poses seen in training are estimated best by the nearest, linear ones by a line") {
    PrincipalMarkerOptions markers;
    markers.tolerance = 60;
    PoseHierarchyOptions options;
    options.dimension = 2;
    const MatrixF poses = swinging_poses(3000);
    const MatrixF seen = poses.topRows(600);
    std::map<std::string, double> rms;
    for (const EstimationScore& one :
         score_estimation(poses, seen, markers, options, Workers(2)).scores) {
        rms[one.method] = one.rms;
        CHECK(one.rms <= one.greatest);
        CHECK(one.share_95 <= one.greatest);
    }
    REQUIRE(rms.size() == 6);
    CHECK(rms["nearest pose"] == Approx(0).margin(1e-3));
    CHECK(rms["nearest pose"] < rms["8 nearest poses"]);
    CHECK(rms["least squares"] < rms["shrinkage"]);
    CHECK(rms["shrinkage"] < rms["global linear"]);
    CHECK_THROWS_AS(score_estimation(poses, MatrixF(0, 18), markers, options, Workers(1)),
                    std::invalid_argument);
}
