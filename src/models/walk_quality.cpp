#include <algorithm>
#include <cmath>
#include <map>

#include "kinetome/formats/kinematics.h"
#include "kinetome/models/motion_quality.h"

namespace kinetome {
namespace {

/// A clip as it is measured.
struct Measured {
    MatrixF positions;
    std::vector<FootContacts> contacts;
    std::vector<double> pose_steps;

    int64_t inside(int64_t frame) const {
        return std::clamp<int64_t>(frame, 0, positions.rows() - 1);
    }
};

std::map<int32_t, Measured> measured_clips(std::span<const Clip> clips,
                                           std::span<const MotionRun> runs,
                                           const ContactOptions& options) {
    std::map<int32_t, Measured> measured;
    for (const MotionRun& run : runs) {
        if (measured.contains(run.clip)) continue;
        const Clip& clip = clips[static_cast<size_t>(run.clip)];
        Measured& one = measured[run.clip];
        one.positions = joint_positions(clip);
        one.contacts = foot_contacts(*clip.skeleton, one.positions, clip.rate, options);
        one.pose_steps = pose_steps(clip, one.positions);
    }
    return measured;
}

MotionRun whole(const Clip& clip) {
    return {.first = 0, .end = static_cast<double>(clip.frames())};
}

}  // namespace

WalkQuality measure_walk(std::span<const Clip> clips, std::span<const MotionRun> runs,
                         const Clip& walk, const ContactOptions& options) {
    const auto takes = measured_clips(clips, runs, options);
    WalkQuality quality;
    for (const auto& [clip, take] : takes) {
        quality.pose_step_in_takes =
            std::max(quality.pose_step_in_takes,
                     largest_step(take.pose_steps, whole(clips[static_cast<size_t>(clip)])));
        quality.peaks_in_takes =
            larger(quality.peaks_in_takes, joint_peaks(take.positions, walk.rate));
    }
    for (const MotionRun& run : runs) {
        const Measured& take = takes.at(run.clip);
        const int64_t first = take.inside(static_cast<int64_t>(std::ceil(run.first)));
        const int64_t count =
            take.inside(static_cast<int64_t>(std::floor(run.end)) - 1) - first + 1;
        if (count <= 0) continue;
        const auto rows = take.positions.middleRows(first, count);
        const auto contacts = std::span(take.contacts)
                                  .subspan(static_cast<size_t>(first), static_cast<size_t>(count));
        quality.slide_in_takes += foot_slide(*walk.skeleton, rows, contacts, walk.rate);
    }
    std::vector<FootContacts> contacts;
    for (const FrameSource& source : sources_of_runs(runs)) {
        const Measured& take = takes.at(source.clip);
        contacts.push_back(take.contacts[static_cast<size_t>(take.inside(source.frame))]);
    }
    const MatrixF positions = joint_positions(walk);
    quality.pose_step = largest_step(pose_steps(walk, positions), whole(walk));
    quality.slide = foot_slide(*walk.skeleton, positions, contacts, walk.rate);
    quality.peaks = joint_peaks(positions, walk.rate);
    return quality;
}

}  // namespace kinetome
