#include "kinetome/models/adapted_radius.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "kinetome/math/quantiles.h"

namespace kinetome {

double median_frame_distance(const MatrixFView& features) {
    constexpr int64_t most_frames = 512;
    const int64_t count = std::min<int64_t>(features.rows(), most_frames);
    if (count < 2) return 0;
    MatrixD frames(count, features.cols());
    for (int64_t i = 0; i < count; ++i) {
        frames.row(i) = features.row(i * features.rows() / count).cast<double>();
    }
    std::vector<double> squares;
    for (int64_t i = 1; i < count; ++i) {
        for (int64_t j = 0; j < i; ++j) {
            squares.push_back((frames.row(i) - frames.row(j)).squaredNorm());
        }
    }
    return std::sqrt(lower_quantile(std::move(squares), 0.5));
}

double adapted_radius(const MatrixFView& features, double radius,
                      const RadiusAdaptation& adaptation) {
    const double share = adaptation.share * median_frame_distance(features);
    return std::min(radius, std::max(adaptation.least, share));
}

}  // namespace kinetome
