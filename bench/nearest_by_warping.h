// Labels of the nearest primitive by plain dynamic time warping: the peer of label transfer.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "kinetome/math/warp.h"
#include "labelled_primitives.h"

namespace kinetome::bench {

/// A primitive's nearest one of another clip.
struct Nearest {
    double cost = std::numeric_limits<double>::infinity();
    bool right = false;
};

/// What a primitive costs by another one.
using WarpCost = std::function<double(const MatrixFView& asked, const MatrixFView& known)>;

/// By comparison with all of them, the nearest first. Poses as they are, as in S3.
inline std::vector<Nearest> nearest_by_warping(const Labelled& data, const WarpCost& cost_of,
                                               int threads) {
    const auto& primitives = data.primitives;
    std::vector<Nearest> nearest(primitives.all.size());
    parallel_for(threads, int64_t(nearest.size()), [&](int64_t i) {
        const auto a = static_cast<size_t>(i);
        for (size_t b = 0; b < nearest.size(); ++b) {
            if (primitives.all[b].clip == primitives.all[a].clip) continue;
            const double cost =
                cost_of(primitives.rows(primitives.poses, a), primitives.rows(primitives.poses, b));
            if (cost < nearest[a].cost) nearest[a] = {cost, data.labels[a] == data.labels[b]};
        }
    });
    std::ranges::stable_sort(nearest, {}, &Nearest::cost);
    return nearest;
}

struct Point {
    double cost = 0, precision = 1, recall = 0;
};

/// Of trusting the nearest up to each of the distances.
inline std::vector<Point> curve_of(const std::vector<Nearest>& nearest) {
    std::vector<Point> curve;
    int64_t right = 0;
    for (size_t i = 0; i < nearest.size(); ++i) {
        right += nearest[i].right;
        curve.push_back({nearest[i].cost, double(right) / double(i + 1),
                         double(right) / double(nearest.size())});
    }
    return curve;
}

/// The highest recall at a precision of at least this.
inline Point best_at(const std::vector<Point>& curve, double precision) {
    Point best;
    for (const Point& point : curve) {
        if (point.precision >= precision && point.recall > best.recall) best = point;
    }
    return best;
}

struct Peer {
    const char* name;
    WarpCost cost;
};

inline std::vector<Peer> peers() {
    const auto whole = [](WarpOptions warping) {
        return [=](const MatrixFView& asked, const MatrixFView& known) {
            return warp(asked, known, warping).mean;
        };
    };
    const auto within = [](const MatrixFView& asked, const MatrixFView& known) {
        double cost = std::numeric_limits<double>::infinity();
        for (const WarpPath& path : warp_matches(asked, known, {})) {
            cost = std::min(cost, path.mean);
        }
        return cost;
    };
    return {
        {"1-nearest DTW, steps (1,1),(0,1),(1,0)", whole({unlimited_steps(), WarpWeight::cells})},
        {"1-nearest DTW, slope 1/2 to 2", whole({slope_limited_steps(), WarpWeight::both})},
        {"1-nearest subsequence DTW", within}};
}

}  // namespace kinetome::bench
