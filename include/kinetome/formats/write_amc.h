// ASF and AMC text that parse_asf and parse_amc read back to the same motion.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "kinetome/formats/clip.h"

namespace kinetome {

/// The skeleton in the units it came in (source_units), angles in degrees. Throws
/// std::invalid_argument for what ASF cannot say: an offset before a joint other than the root or
/// after the root, rotations whose first acts last, a root not called "root" (all usual in BVH
/// rigs; write_bvh holds them).
std::string write_asf(const Skeleton& skeleton);

/// A whole take.
std::string write_amc(const Clip& clip);

/// The parts of a take, for those who write it frame by frame. Angles are rounded to 1e-5 degrees,
/// lengths to 1e-5 of the source's unit; limbs of a metre move by less than 1e-4 cm.
void append_amc_header(std::string& text);
/// `dofs` has skeleton.dof_count() values, finite, in cm and radians. Throws std::invalid_argument.
void append_amc_frame(std::string& text, const Skeleton& skeleton, int64_t frame_number,
                      std::span<const float> dofs);

}  // namespace kinetome
