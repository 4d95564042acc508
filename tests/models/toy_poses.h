// Poses of a few markers with a known shape, for tests of pose models.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/random.h"

/// n poses of 6 markers, cm, the first at the origin: the others swing at their own rates about
/// their places, so that no line holds the poses, but short runs of them nearly lie on one.
inline kinetome::MatrixF swinging_poses(int64_t frames, uint64_t seed = 1) {
    kinetome::RandomStream random(seed, "swinging_poses");
    kinetome::MatrixF poses = kinetome::MatrixF::Zero(frames, 18);
    for (int64_t i = 0; i < frames; ++i) {
        const double t = 0.01 * double(i);
        for (int64_t j = 3; j < 18; ++j) {
            const double swing = std::sin(t * (1 + 0.1 * double(j % 4)) + double(j));
            poses(i, j) =
                static_cast<float>(10 * double(j % 5) + 20 * swing + 0.05 * random.normal());
        }
    }
    return poses;
}

/// n × p: some columns of rows.
inline kinetome::MatrixF columns_of(const kinetome::MatrixF& rows,
                                    const std::vector<int32_t>& columns) {
    return rows(Eigen::all, columns);
}
