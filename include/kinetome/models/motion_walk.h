// Runs of clips joined to one motion: walks through a motion graph, and any other sequence.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/formats/clip.h"
#include "kinetome/models/foot_contacts.h"
#include "kinetome/models/motion_graph.h"

namespace kinetome {

/// A stretch of a clip that is played without a break: its frames [first, end), which need not be
/// whole. Its first `fade_in` frames and the last `fade_out` frames of the run before are played
/// together, while the one goes over into the other.
///
/// Both sides pass through a fade in equal shares, or as `registration` says: at first at the speed
/// of the one, at last at the speed of the other, in between slower as far as it is to last longer.
struct MotionRun {
    int32_t clip = 0;
    double first = 0, end = 0;
    double fade_in = 0;
    double fade_out = 0;     ///< 0 in the last run
    double fade_frames = 0;  ///< that the fade in lasts, natural_fade_frames or more; 0: these
    /// Shares of fade_in, ascending from 0 to 1, that answer even shares of the fade_out before it;
    /// empty: the same ones.
    std::vector<double> registration = {};
    bool operator==(const MotionRun&) const = default;
};

/// What a fade lasts between so many frames of the run before and of the run after it: their mean,
/// unless the registration has the one pass faster while it is seen more.
double natural_fade_frames(double fade_out, double fade_in, std::span<const double> registration);

/// When a run is seen in the whole, its fades included; frames, not rounded.
struct RunTime {
    double first = 0, end = 0;
};
std::vector<RunTime> times_of_runs(std::span<const MotionRun> runs);
/// Length of what play_runs makes, in frames, not rounded.
double frames_of_runs(std::span<const MotionRun> runs);

/// How firmly feet stand in the frames of each clip (foot_support); of no clip: feet are not held.
using ClipSupports = std::vector<std::vector<FootSupport>>;

/// The runs as one motion: rotations by slerp with smoothstep weights in a fade, place and heading
/// going on from where they are (MotionBlend). Clips are of one skeleton and one rate; a run may
/// reach beyond its clip's ends, where the pose is held. Throws std::invalid_argument for clips
/// that differ, runs of clips that are not there, runs shorter than their fades, fades shorter
/// than natural_fade_frames, registrations that do not ascend from 0 to 1, or no run.
Clip play_runs(std::span<const Clip> clips, std::span<const MotionRun> runs,
               const ClipSupports& supports = {});

/// The clip that is seen most in a frame of the whole, and the nearest of its frames.
struct FrameSource {
    int32_t clip = 0;
    int64_t frame = 0;  ///< before the clip's first or past its last one where the pose is held
};
/// One a frame of what play_runs makes.
std::vector<FrameSource> sources_of_runs(std::span<const MotionRun> runs);

/// Pieces one after another, with fades of at most `fade_frames` about every seam: frames before
/// the next piece's first and after the last piece's end are blended there, so that the sequence is
/// as long as its pieces. A fade reaches at most to the middle of a piece; none where a piece goes
/// on in its own clip.
std::vector<MotionRun> runs_of_pieces(std::span<const MotionPiece> pieces, double fade_frames);

}  // namespace kinetome
