// When feet stand on the floor.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/skeleton.h"

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

/// How firmly each foot stands, from 0 to 1.
using FootSupport = std::array<double, foot_roles.size()>;

/// The share of the time around each frame, `seconds` in all, in which a foot stands: so that what
/// holds it neither begins nor ends at once. Throws std::invalid_argument unless the rate is
/// positive.
std::vector<FootSupport> foot_support(std::span<const FootContacts> contacts, double rate,
                                      double seconds = 0.1);

/// That of the frame nearest to a moment, in frames; none at all where no support is given.
FootSupport support_at(std::span<const FootSupport> support, double moment);

}  // namespace kinetome
