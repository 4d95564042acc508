#include "kinetome/models/adapted_radius.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "kinetome/base/random.h"
#include "kinetome/models/neighbor_graph.h"

using namespace kinetome;

namespace {

MatrixF scattered(int64_t frames) {
    RandomStream random(11, "scattered");
    MatrixF rows(frames, 9);
    for (int64_t i = 0; i < rows.size(); ++i) rows.data()[i] = float(60 * random.uniform());
    return rows;
}

}  // namespace

TEST_CASE("the median distance of a small take is that of all its pairs of frames") {
    for (const int64_t frames : {2, 3, 7, 512}) {
        const MatrixF rows = scattered(frames);
        std::vector<double> distances;
        for (int64_t i = 0; i < frames; ++i) {
            for (int64_t j = i + 1; j < frames; ++j) {
                distances.push_back((rows.row(i) - rows.row(j)).cast<double>().norm());
            }
        }
        std::sort(distances.begin(), distances.end());
        CHECK(median_frame_distance(rows) ==
              Approx(distances[(distances.size() - 1) / 2]).epsilon(1e-6));
    }
    CHECK(median_frame_distance(scattered(1)) == 0);
    CHECK(median_frame_distance(MatrixF(0, 9)) == 0);
    CHECK(median_frame_distance(MatrixF::Constant(1000, 9, 5)) == 0);
}

TEST_CASE("the median distance of a long take is nearly that of all its pairs") {
    CHECK(median_frame_distance(scattered(5000)) ==
          Approx(median_frame_distance(scattered(512))).epsilon(0.05));
}

TEST_CASE("a radius shrinks with the motion, neither above the one given nor below jitter") {
    const MatrixF rows = scattered(400);
    const double median = median_frame_distance(rows);
    const RadiusAdaptation half{.share = 0.5, .least = 2};
    CHECK(adapted_radius(rows, 1e6, half) == Approx(median / 2));
    CHECK(adapted_radius(rows / 8, 1e6, half) == Approx(median / 16));
    CHECK(adapted_radius(rows, median / 4, half) == median / 4);
    CHECK(adapted_radius(rows / 1000, 72, half) == 2);
    CHECK(adapted_radius(rows / 1000, 1, half) == 1);
}

TEST_CASE("with the radius adapted, the same motion has the same graph at any amplitude") {
    MatrixF rows(600, 9);  // turns that repeat, slower and faster
    for (int64_t i = 0; i < rows.rows(); ++i) {
        for (int64_t j = 0; j < rows.cols(); ++j) {
            rows(i, j) = 64 * std::sin(0.05F * float(i) + 0.0001F * float(i * i) + float(j));
        }
    }
    const auto graph_at = [&](float amplitude) {
        const MatrixF scaled = rows * amplitude;  // powers of two: no rounding
        const double radius = adapted_radius(scaled, 1000, {.share = 0.3, .least = 0.01});
        return neighbor_graph(scaled, {radius, 1000}, KnnEngine::blocks, 1);
    };
    const NeighborGraph whole = graph_at(1), low = graph_at(0.125F);
    CHECK(low.offsets() == whole.offsets());
    CHECK(low.all_neighbours() == whole.all_neighbours());
    CHECK(whole.all_neighbours().size() > 600 * 20);
    CHECK(whole.all_neighbours().size() < 600 * 400);
}
