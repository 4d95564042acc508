// BVH text of a clip of any skeleton.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kinetome/formats/clip.h"
#include "kinetome/formats/kinematics.h"

namespace kinetome {

/// Writes a take frame by frame, in centimetres and degrees.
///
/// A BVH joint stands where its bone begins: its OFFSET is the parent's bone, and an End Site ends
/// the last one. Axes (ASF `axis`) are folded into the rotations, so every joint has the channels
/// Zrotation Yrotation Xrotation (R = Rz·Ry·Rx) with angles that stay nearest to the frame before,
/// also through gimbal lock. Positions of a joint with translations replace its OFFSET, as readers
/// of the format expect of the root. Numbers have 6 decimals: limbs of a metre move by less than
/// 1e-5 cm.
class BvhWriter {
  public:
    explicit BvhWriter(std::shared_ptr<const Skeleton> skeleton);

    /// The hierarchy and the head of the motion. `rate` in frames a second.
    void append_header(std::string& text, int64_t frames, double rate) const;
    /// `dofs` has skeleton.dof_count() values, finite, in cm and radians.
    void append_frame(std::string& text, std::span<const float> dofs);

  private:
    void append_joint(std::string& text, int joint, int depth) const;

    std::shared_ptr<const Skeleton> skeleton_;
    std::vector<std::vector<int>> children_;
    std::vector<int> written_order_;            ///< joints as the hierarchy names them
    std::vector<Eigen::Vector3d> offsets_;      ///< cm, from the parent's beginning to the joint's
    std::vector<Eigen::Vector3d> last_angles_;  ///< radians about x, y, z, one a joint
};

/// A whole take.
std::string write_bvh(const Clip& clip);

}  // namespace kinetome
