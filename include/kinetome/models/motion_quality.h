// How sound a motion is that was put together: whether feet slide, whether joints jump.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/clip.h"
#include "kinetome/models/foot_contacts.h"
#include "kinetome/models/motion_walk.h"

namespace kinetome {

/// How far feet go along the floor while they stand.
struct FootSlide {
    double distance = 0;  ///< cm
    double seconds = 0;   ///< of contact, all joints added up

    /// cm a second of contact.
    double speed() const { return seconds > 0 ? distance / seconds : 0; }
    FootSlide& operator+=(const FootSlide& other);
};

/// Feet that stand in a frame and in the one before; `contacts` one a row of `positions`.
FootSlide foot_slide(const Skeleton& skeleton, const MatrixFView& positions,
                     std::span<const FootContacts> contacts, double rate);

/// The fastest that any joint moves, and the greatest change of that from one frame to the next.
struct JointPeaks {
    double speed = 0;         ///< cm/s
    double acceleration = 0;  ///< cm/s²
};
JointPeaks joint_peaks(const MatrixFView& positions, double rate);
/// Of each frame, as it is come to from the one before, and from the two before.
std::vector<JointPeaks> joint_peaks_by_frame(const MatrixFView& positions, double rate);
JointPeaks larger(const JointPeaks& one, const JointPeaks& other);

/// How fast the pose of each frame changes to that of the next, place and heading removed, cm/s:
/// the root mean square over the markers (normalised_markers). One less than the clip has frames.
std::vector<double> pose_steps(const Clip& clip);
/// The same, of a clip whose joint_positions are known.
std::vector<double> pose_steps(const Clip& clip, const MatrixFView& positions);
/// The largest of those inside a run's frames of its clip; 0 where there is none.
double largest_step(std::span<const double> pose_steps, const MotionRun& run);

/// A motion joined from runs of clips, beside the clips where they come from.
struct WalkQuality {
    FootSlide slide, slide_in_takes;   ///< in the runs
    JointPeaks peaks, peaks_in_takes;  ///< in the whole clips
    double pose_step = 0;              ///< the largest, cm/s
    double pose_step_in_takes = 0;     ///< in the whole clips
};
/// `walk` is what play_runs makes of the runs. Its feet are taken to stand where they do in the
/// clip that is seen most: a foot that is dragged by a blend counts. Throws what foot_contacts
/// throws.
WalkQuality measure_walk(std::span<const Clip> clips, std::span<const MotionRun> runs,
                         const Clip& walk, const ContactOptions& options = {});

}  // namespace kinetome
