// Bundles of takes, found and scored: shared by the benchmarks of motion bundles.
#pragma once

#include <cmath>
#include <vector>

#include "cost.h"
#include "kinetome/base/random.h"
#include "kinetome/models/bundle_score.h"
#include "kinetome/models/motion_bundle.h"
#include "spelled_takes.h"

namespace kinetome::bench {

struct Found {
    std::vector<SubstringBundle> bundles;
    double seconds = 0;
};

inline Found find(const SpelledTakes& takes, const MotionBundleOptions& options, int threads,
                  double tau) {
    const AccessibilityMatrix accessible = accessibility_for_bundles(
        accessibility(takes.mixture, tau, threads), takes.string, takes.mixture, options);
    Found found;
    found.seconds = cost_of([&] {
                        found.bundles = find_motion_bundles(takes.string, accessible, takes.lambda,
                                                            options, {.threads = threads});
                    }).wall;
    return found;
}

/// At the string's own τ.
inline Found find(const SpelledTakes& takes, const MotionBundleOptions& options, int threads) {
    return find(takes, options, threads, takes.tau);
}

inline BundleScore score(const MotionString& string, const std::vector<SubstringBundle>& bundles,
                         const std::vector<FrameClasses>& classes) {
    std::vector<MotionPiece> members;
    std::vector<int32_t> bundle_of;
    for (size_t b = 0; b < bundles.size() && !bundles[b].is_degenerate(); ++b) {
        for (const Substring& member : bundles[b].members) {
            members.push_back({string.clip[static_cast<size_t>(member.first)],
                               static_cast<int64_t>(string.mean_frame(member.first)),
                               static_cast<int64_t>(string.mean_frame(member.last))});
            bundle_of.push_back(static_cast<int32_t>(b));
        }
    }
    return score_bundles(members, bundle_of, classes);
}

/// Pose vectors with noise of a tenth of each column's standard deviation.
inline void add_noise(PoseTakes& takes) {
    RandomStream random(1, "bundles bench noise");
    for (Eigen::Index column = 0; column < takes.poses.cols(); ++column) {
        const auto values = takes.poses.col(column).cast<double>();
        const double deviation = std::sqrt((values.array() - values.mean()).square().mean());
        for (Eigen::Index row = 0; row < takes.poses.rows(); ++row)
            takes.poses(row, column) += static_cast<float>(0.1 * deviation * random.normal());
    }
}

}  // namespace kinetome::bench
