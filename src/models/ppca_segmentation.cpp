#include "kinetome/models/ppca_segmentation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "kinetome/math/moments.h"
#include "kinetome/math/symmetric_eigen.h"

namespace kinetome {
namespace {

/// Variance below which nothing moves: about a thousandth of a turn, squared. It keeps a Gaussian
/// of motionless frames from being infinitely surprised.
constexpr double least_variance = 1e-8;

/// Variances along the principal axes: as they are for those that hold the share, their mean for
/// the others.
VectorD with_isotropic_rest(VectorD variances, double kept_share) {
    const double total = variances.sum();
    double held = 0;
    int64_t kept = 0;
    while (kept < variances.size() && held < kept_share * total) held += variances[kept++];
    const int64_t rest = variances.size() - kept;
    if (rest > 0) variances.tail(rest).setConstant(variances.tail(rest).mean());
    return variances.cwiseMax(least_variance);
}

double distance_between(const Moments& known, const Moments& ahead, double kept_variance) {
    const auto [values, axes] = symmetric_eigen(known.scatter / double(known.count - 1));
    const VectorD variances = with_isotropic_rest(values.cwiseMax(0.0), kept_variance);
    const VectorD offset = axes.transpose() * (ahead.mean - known.mean);
    double distance = 0;
    for (int64_t j = 0; j < variances.size(); ++j) {
        const double spread = axes.col(j).dot(ahead.scatter * axes.col(j)) / double(ahead.count);
        distance += (spread + offset[j] * offset[j]) / variances[j];
    }
    return distance;
}

/// Watches distances for the highest one between a rise and a fall by a factor.
class PeakWatch {
  public:
    explicit PeakWatch(double least_rise) : least_rise_(least_rise) {}

    /// Whether the distance has come down from a peak.
    bool passed_peak(int64_t frame, double distance) {
        if (!risen_) {
            valley_ = std::min(valley_, distance);
            risen_ = distance > least_rise_ * valley_;
        }
        if (risen_ && distance > peak_) {
            peak_ = distance;
            peak_frame_ = frame;
        }
        return risen_ && distance * least_rise_ <= peak_;
    }
    int64_t peak_frame() const { return peak_frame_; }

  private:
    double least_rise_;
    double valley_ = std::numeric_limits<double>::infinity();
    double peak_ = 0;
    int64_t peak_frame_ = 0;
    bool risen_ = false;
};

int64_t frames_of(double seconds, double rate) {
    return std::max<int64_t>(1, std::llround(seconds * rate));
}

/// From one cut to the next; nothing when the take ends before a peak.
std::optional<int64_t> next_cut(const MatrixFView& features, int64_t start,
                                const PpcaSegmentationOptions& options) {
    const int64_t window = frames_of(options.window, options.rate);
    const int64_t step = std::min(frames_of(options.step, options.rate), window);
    PeakWatch watch(options.least_rise);
    Moments known;
    if (start + 2 * window <= features.rows()) {
        known = moments_of(features.middleRows(start, window));
    }
    for (int64_t now = start + window; now + window <= features.rows(); now += step) {
        const Moments ahead = moments_of(features.middleRows(now, window));
        const double distance = distance_between(known, ahead, options.kept_variance);
        if (watch.passed_peak(now, distance)) return watch.peak_frame();
        merge(known, moments_of(features.middleRows(now, step)));
    }
    return std::nullopt;
}

std::vector<int64_t> cuts_forward(const MatrixFView& features,
                                  const PpcaSegmentationOptions& options) {
    std::vector<int64_t> cuts;
    int64_t start = 0;
    while (const auto cut = next_cut(features, start, options)) {
        cuts.push_back(*cut);
        start = *cut;
    }
    return cuts;
}

/// Cuts in order, runs of near ones replaced by their mean.
std::vector<int64_t> merge_near(const std::vector<int64_t>& cuts, int64_t spacing) {
    std::vector<int64_t> merged;
    for (size_t first = 0; first < cuts.size();) {
        size_t end = first;
        int64_t sum = 0;
        while (end < cuts.size() && (end == first || cuts[end] - cuts[end - 1] < spacing)) {
            sum += cuts[end++];
        }
        merged.push_back(sum / static_cast<int64_t>(end - first));
        first = end;
    }
    return merged;
}

}  // namespace

double distance_from_ppca(const MatrixFView& known, const MatrixFView& ahead,
                          double kept_variance) {
    if (known.rows() < 2 || ahead.rows() < 1 || known.cols() != ahead.cols()) {
        throw std::invalid_argument("frames to compare are missing or of another dimension");
    }
    return distance_between(moments_of(known), moments_of(ahead), kept_variance);
}

std::vector<int64_t> ppca_cuts(const MatrixFView& features,
                               const PpcaSegmentationOptions& options) {
    std::vector<int64_t> cuts = cuts_forward(features, options);
    const MatrixF reversed = features.colwise().reverse();
    for (const int64_t cut : cuts_forward(reversed, options)) {
        cuts.push_back(features.rows() - cut);
    }
    std::sort(cuts.begin(), cuts.end());
    return merge_near(cuts, frames_of(options.least_spacing, options.rate));
}

std::vector<Segment> ppca_segments(const MatrixFView& features,
                                   const PpcaSegmentationOptions& options) {
    std::vector<Segment> segments;
    int64_t first = 0;
    std::vector<int64_t> ends = ppca_cuts(features, options);
    if (features.rows() > 0) ends.push_back(features.rows());
    for (const int64_t end : ends) {
        const auto cluster = static_cast<int32_t>(segments.size());
        segments.push_back({{first, end}, SegmentKind::activity, cluster});
        first = end;
    }
    return segments;
}

}  // namespace kinetome
