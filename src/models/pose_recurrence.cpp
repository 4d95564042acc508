#include "kinetome/models/pose_recurrence.h"

#include <algorithm>
#include <cmath>

namespace kinetome {

PoseRecurrence& PoseRecurrence::operator+=(const PoseRecurrence& other) {
    takes += other.takes;
    recurring_takes += other.recurring_takes;
    frames += other.frames;
    recurring_frames += other.recurring_frames;
    return *this;
}

std::vector<char> recurring_frames(const MatrixFView& features,
                                   const PoseRecurrenceOptions& options) {
    const int64_t frames = features.rows();
    const int64_t intermission =
        std::max<int64_t>(1, std::llround(options.least_intermission * options.rate));
    const int64_t farthest = std::llround(options.longest_return * options.rate);
    std::vector<char> recurring(static_cast<size_t>(frames), false);
    for (int64_t i = 0; i < frames; ++i) {
        bool has_been_elsewhere = false;
        int64_t different = 0;  // frames on end
        for (int64_t later = i + 1; later < frames && later - i <= farthest; ++later) {
            const bool same =
                double((features.row(later) - features.row(i)).norm()) <= options.radius;
            if (same && has_been_elsewhere) recurring[size_t(i)] = recurring[size_t(later)] = true;
            different = same ? 0 : different + 1;
            has_been_elsewhere |= different >= intermission;
        }
    }
    return recurring;
}

PoseRecurrence pose_recurrence(const MatrixFView& features, const PoseRecurrenceOptions& options) {
    if (double(features.rows()) <= options.shortest_take * options.rate) return {};
    const std::vector<char> recurring = recurring_frames(features, options);
    const int64_t frames = std::count(recurring.begin(), recurring.end(), true);
    return {1, frames > 0, features.rows(), frames};
}

}  // namespace kinetome
