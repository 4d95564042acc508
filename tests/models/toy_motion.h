// Movements whose cycles are known exactly, in features that need no body.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "kinetome/base/matrix.h"
#include "kinetome/base/random.h"
#include "kinetome/models/neighbor_graph.h"

namespace kinetome::toy {

inline constexpr int64_t columns = 6;

/// Rows of features, each movement one after another, with a capture system's noise on top.
class Motion {
  public:
    /// A limb that goes round in the plane of columns `plane` and `plane` + 1.
    Motion& circle(int64_t cycles, int64_t period, int plane, double radius = 100) {
        return append(cycles * period, [=](int64_t frame, Eigen::Ref<Eigen::RowVectorXd> row) {
            const double phase = 2 * std::numbers::pi * double(frame) / double(period);
            row[plane] = radius * std::cos(phase);
            row[plane + 1] = radius * std::sin(phase);
        });
    }
    /// A limb that is raised along column `axis` and goes back the way it came.
    Motion& raise(int64_t cycles, int64_t period, int axis, double height = 200) {
        return append(cycles * period, [=](int64_t frame, Eigen::Ref<Eigen::RowVectorXd> row) {
            const double phase = 2 * std::numbers::pi * double(frame) / double(period);
            row[axis] = height * (1 - std::cos(phase)) / 2;
        });
    }
    /// Nothing moves; `where` tells apart one posture from another.
    Motion& hold(int64_t frames, double where) {
        return append(frames,
                      [=](int64_t, Eigen::Ref<Eigen::RowVectorXd> row) { row.setConstant(where); });
    }

    MatrixF rows(double noise = 0.1) const {
        RandomStream random(5, "toy motion");
        MatrixF noisy = rows_.cast<float>();
        for (float& value : noisy.reshaped()) value += static_cast<float>(noise * random.normal());
        return noisy;
    }

  private:
    template <class Posture>
    Motion& append(int64_t frames, const Posture& posture) {
        const int64_t before = rows_.rows();
        rows_.conservativeResize(before + frames, columns);
        rows_.bottomRows(frames).setZero();
        for (int64_t frame = 0; frame < frames; ++frame) posture(frame, rows_.row(before + frame));
        return *this;
    }

    MatrixD rows_ = MatrixD(0, columns);
};

/// The graph that segmentation is given unless said otherwise.
inline NeighborGraph graph_of(const MatrixF& rows) {
    return neighbor_graph(rows, {72, 128}, KnnEngine::blocks, 1);
}

}  // namespace kinetome::toy
