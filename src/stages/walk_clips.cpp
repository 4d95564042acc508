#include "walk_clips.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/features/markers.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/resample.h"
#include "kinetome/models/retarget.h"

namespace kinetome {
namespace {

/// Poses of a piece, without place and heading: every `stride` frames a row.
MatrixF poses_of(const Clip& clip, const MotionPiece& piece, int64_t stride) {
    const int64_t end = std::min(piece.end, clip.frames());
    const int64_t rows = std::max<int64_t>((end - piece.first + stride - 1) / stride, 0);
    Clip part{clip.skeleton, MatrixF(rows, clip.motion.cols()), clip.rate};
    for (int64_t row = 0; row < rows; ++row) {
        part.motion.row(row) = clip.motion.row(piece.first + row * stride);
    }
    return normalised_markers(*clip.skeleton, part.motion, joint_positions(part));
}

/// Negative below.
double share_above(double value, double bound) {
    return bound > 0 ? value / bound - 1 : value;
}

MotionRun run_of(const MotionPiece& piece) {
    return {.clip = piece.clip,
            .first = static_cast<double>(piece.first),
            .end = static_cast<double>(piece.end)};
}

/// Frames from one pose that is compared to the next: fine enough for the rate, and for pieces
/// that are short.
int64_t stride_of(const MotionPiece& entry, const MotionPiece& exit, double rate) {
    constexpr double poses_a_second = 30;
    constexpr int64_t fewest_poses = 16;
    const int64_t finest = std::min(entry.frames(), exit.frames()) / fewest_poses;
    return std::clamp<int64_t>(finest, 1,
                               std::max<int64_t>(std::llround(rate / poses_a_second), 1));
}

}  // namespace

WalkClips::WalkClips(const StoredGraph& graph, const ClipSource& source, const WalkOptions& options,
                     const std::string& body)
    : graph_(graph),
      source_(source),
      options_(options),
      body_(body),
      clips_(graph.clips.size()),
      supports_(graph.clips.size()),
      peaks_(graph.clips.size()) {
    const std::string body_class = source.kind(body).clip_class;
    const std::string clip_class = source.kind(graph.clips.front()).clip_class;
    if (body_class != clip_class) {
        throw UsageError(
            fmt::format("--body {}: it is of class {}, the walk's {}s of class {}; name a "
                        "clip of that class",
                        quote_for_message(body), body_class, graph.nodes.style.piece, clip_class));
    }
    skeleton_ = source.read(body).skeleton;
}

const Clip& WalkClips::clip(int32_t number) {
    const auto at = static_cast<size_t>(number);
    Clip& clip = clips_[at];
    if (clip.skeleton) return clip;
    clip = retarget(resample(source_.read(graph_.clips[at]), graph_.rate), skeleton_);
    const MatrixF positions = joint_positions(clip);
    supports_[at] = foot_support(foot_contacts(*clip.skeleton, positions, clip.rate), clip.rate);
    peaks_[at] = measured_peaks(number, positions);
    return clip;
}

WalkClips::Peaks& WalkClips::Peaks::operator|=(const Peaks& other) {
    pose_step = std::max(pose_step, other.pose_step);
    joints = larger(joints, other.joints);
    return *this;
}

double WalkClips::Peaks::excess(const Peaks& bound) const {
    constexpr double rounding = 1e-4;  // of places on the floor, seen as accelerations
    return std::max({share_above(pose_step, bound.pose_step),
                     share_above(joints.speed, bound.joints.speed),
                     share_above(joints.acceleration, bound.joints.acceleration) - rounding});
}

std::vector<WalkClips::Peaks> WalkClips::peaks_by_frame(const Clip& clip,
                                                        const MatrixFView& positions) {
    const std::vector<double> steps = pose_steps(clip, positions);
    const std::vector<JointPeaks> joints = joint_peaks_by_frame(positions, clip.rate);
    std::vector<Peaks> peaks;
    for (size_t frame = 0; frame < joints.size(); ++frame)
        peaks.push_back({frame > 0 ? steps[frame - 1] : 0, joints[frame]});
    return peaks;
}

WalkClips::Peaks WalkClips::measured_peaks(int32_t number, const MatrixFView& positions) const {
    const Clip& clip = clips_[static_cast<size_t>(number)];
    const std::vector<double> steps = pose_steps(clip, positions);
    Peaks peaks{.joints = joint_peaks(positions, clip.rate)};
    for (const MotionPiece& piece : graph_.nodes.graph.pieces()) {
        if (piece.clip == number)
            peaks.pose_step = std::max(peaks.pose_step, largest_step(steps, run_of(piece)));
    }
    return peaks;
}

const Crossing& WalkClips::crossing(int32_t entry, int32_t exit) {
    const auto [found, is_new] = crossings_.try_emplace({entry, exit});
    if (is_new) {
        found->second = crossing(entry, exit,
                                 fade_lengths(graph_.nodes.graph.piece(entry),
                                              graph_.nodes.graph.piece(exit), fade_frames()));
    }
    return found->second;
}

Crossing WalkClips::crossing(int32_t entry, int32_t exit, const Crossing& fade) {
    const MotionPiece& in = graph_.nodes.graph.piece(entry);
    const MotionPiece& out = graph_.nodes.graph.piece(exit);
    const int64_t stride = stride_of(in, out, graph_.rate);
    const auto rows = static_cast<double>(stride);
    Crossing crossing =
        best_crossing(poses_of(clip(in.clip), in, stride), poses_of(clip(out.clip), out, stride),
                      fade.entry / rows, fade.exit / rows);
    crossing.entry *= rows;
    crossing.exit *= rows;
    if (!options_.registered) crossing.registration.clear();
    return crossing;
}

BlendPart WalkClips::part(int32_t piece, int32_t registered_to, double weight) {
    const MotionPiece& own = graph_.nodes.graph.piece(piece);
    const MotionPiece& other = graph_.nodes.graph.piece(registered_to);
    BlendPart part{.clip = &clip(own.clip), .first = own.first, .end = own.end, .weight = weight};
    part.support = supports_[static_cast<size_t>(own.clip)];
    if (piece != registered_to) {
        const Crossing whole{.entry = static_cast<double>(other.frames()),
                             .exit = static_cast<double>(own.frames())};
        part.registration = crossing(registered_to, piece, whole).registration;
    }
    return part;
}

std::vector<MotionRun> WalkClips::runs(const GraphWalk& walk) {
    const MotionGraph& graph = graph_.nodes.graph;
    for (const WalkStep& step : walk.steps) clip(graph.piece(step.entry).clip);
    return runs_of_walk(graph, walk.steps, fade_frames(),
                        [&](int32_t entry, int32_t exit) { return crossing(entry, exit); });
}

double WalkClips::excess(int32_t entry, int32_t exit) {
    if (entry == exit) return 0;
    const auto [found, is_new] = excesses_.try_emplace({entry, exit});
    if (!is_new) return found->second;
    const auto node = graph_.nodes.graph.node_of(entry);
    std::vector<MotionRun> there = runs({.steps = {{node, entry, exit}}});
    Peaks allowed;
    for (const MotionRun& run : there) allowed |= peaks_[static_cast<size_t>(run.clip)];
    // What is a frame long leaps from the frames before to those after.
    there.front().first -= 2;
    there.back().end += 2;
    const Clip played = play_runs(clips_, there, supports_);
    Peaks largest;
    for (const Peaks& peaks : peaks_by_frame(played, joint_positions(played))) largest |= peaks;
    return found->second = largest.excess(allowed);
}

bool WalkClips::mend(const GraphWalk& walk, const std::vector<MotionRun>& runs,
                     const Clip& motion) {
    const std::vector<RunTime> times = times_of_runs(runs);
    const auto frames = static_cast<double>(motion.frames());
    const auto for_each_frame = [&](double first, double end, const auto& visit) {
        for (double at = std::max(first, 0.0); at < std::min(end, frames); ++at)
            visit(static_cast<size_t>(at));
    };
    // A frame is told from the two before.
    constexpr double reach = 2;
    std::vector<Peaks> allowed(static_cast<size_t>(motion.frames()));
    for (size_t i = 0; i < runs.size(); ++i) {
        for_each_frame(times[i].first, times[i].end + reach, [&](size_t frame) {
            allowed[frame] |= peaks_[static_cast<size_t>(runs[i].clip)];
        });
    }
    const std::vector<Peaks> peaks = peaks_by_frame(motion, joint_positions(motion));
    constexpr double slower = 1.25, slowest = 8;
    bool is_mended = false;
    size_t run = 0;
    for (const WalkStep& step : walk.steps) {
        if (step.entry == step.exit) continue;
        ++run;
        double largest = 0;
        for_each_frame(times[run].first, times[run - 1].end + reach, [&](size_t frame) {
            largest = std::max(largest, peaks[frame].excess(allowed[frame]));
        });
        if (largest <= 0) continue;
        const std::pair pair(step.entry, step.exit);
        double& slowness = crossings_.at(pair).slowness;
        double& known = excesses_[pair];
        if (known > 0 && slowness * slower > slowest) continue;
        if (known > 0) slowness *= slower;
        known = std::max(known, largest);
        is_mended = true;
    }
    return is_mended;
}

}  // namespace kinetome
