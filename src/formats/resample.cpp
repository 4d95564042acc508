#include "kinetome/formats/resample.h"

#include <cmath>
#include <span>
#include <stdexcept>
#include <vector>

#include "kinetome/formats/pose_interpolation.h"

namespace kinetome {
namespace {

void check_rate(double rate) {
    if (rate > 0 && std::isfinite(rate)) return;
    throw std::invalid_argument("the rate of a clip must be a positive number");
}

}  // namespace

double source_frame(int64_t row, double from_rate, double to_rate) {
    return static_cast<double>(row) * from_rate / to_rate;
}

int64_t resampled_frames(int64_t frames, double from_rate, double to_rate) {
    check_rate(from_rate);
    check_rate(to_rate);
    if (frames <= 0) return 0;
    const auto last = static_cast<double>(frames - 1);
    auto rows = static_cast<int64_t>(last * to_rate / from_rate) + 1;
    // The division may have rounded to either side of a whole number.
    while (source_frame(rows, from_rate, to_rate) <= last) ++rows;
    while (source_frame(rows - 1, from_rate, to_rate) > last) --rows;
    return rows;
}

Clip sample(const Clip& clip, std::span<const double> source_frames, double rate) {
    const PoseInterpolation interpolate(*clip.skeleton);
    const auto dof_count = static_cast<size_t>(clip.motion.cols());
    Clip result{clip.skeleton, {}, rate, clip.warnings};
    result.motion.resize(static_cast<int64_t>(source_frames.size()), clip.motion.cols());
    for (int64_t row = 0; row < result.frames(); ++row) {
        const double at = source_frames[static_cast<size_t>(row)];
        if (!(at >= 0 && at <= static_cast<double>(clip.frames() - 1))) {
            throw std::invalid_argument("a clip can be sampled inside its frames only");
        }
        const auto frame = static_cast<int64_t>(at);
        const double share = at - static_cast<double>(frame);
        if (share == 0) {
            result.motion.row(row) = clip.motion.row(frame);
        } else {
            interpolate({clip.motion.row(frame).data(), dof_count},
                        {clip.motion.row(frame + 1).data(), dof_count}, share,
                        {result.motion.row(row).data(), dof_count});
        }
    }
    return result;
}

Clip resample(const Clip& clip, double rate) {
    check_rate(rate);
    if (rate == clip.rate) return clip;
    std::vector<double> moments(
        static_cast<size_t>(resampled_frames(clip.frames(), clip.rate, rate)));
    for (size_t row = 0; row < moments.size(); ++row) {
        moments[row] = source_frame(static_cast<int64_t>(row), clip.rate, rate);
    }
    return sample(clip, moments, rate);
}

}  // namespace kinetome
