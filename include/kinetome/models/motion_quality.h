// How sound a motion is that was put together: whether feet slide, whether joints jump.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/clip.h"
#include "kinetome/models/motion_walk.h"

namespace kinetome {

/// Joints that stand on the floor.
inline constexpr std::array foot_roles = {JointRole::left_ankle, JointRole::right_ankle,
                                          JointRole::left_toes, JointRole::right_toes};
using FootContacts = std::array<bool, foot_roles.size()>;

struct ContactOptions {
    double height = 4;          ///< cm above where the joint stands on the floor
    double speed = 30;          ///< cm/s that the joint moves at most
    double floor_share = 0.02;  ///< of its frames in which a joint may be below its floor: noise
};

/// Which feet stand in each frame of a take. `positions` are n × 3·joint_count, cm (kinematics.h);
/// a joint that the skeleton lacks never stands. Throws std::invalid_argument when the shapes
/// disagree or the rate is not positive.
std::vector<FootContacts> foot_contacts(const Skeleton& skeleton, const MatrixFView& positions,
                                        double rate, const ContactOptions& options = {});

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
JointPeaks larger(const JointPeaks& one, const JointPeaks& other);

/// A motion joined from runs of clips, beside those runs where they come from.
struct WalkQuality {
    FootSlide slide, slide_in_takes;
    JointPeaks peaks, peaks_in_takes;
};
/// `walk` is what play_runs makes of the runs. Its feet are taken to stand where they do in the
/// clip that is seen most: a foot that is dragged by a blend counts. Throws what foot_contacts
/// throws.
WalkQuality measure_walk(std::span<const Clip> clips, std::span<const MotionRun> runs,
                         const Clip& walk, const ContactOptions& options = {});

}  // namespace kinetome
