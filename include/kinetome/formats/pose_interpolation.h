// Frames between two frames of one skeleton.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// A skeleton made ready to be interpolated many times. Translations are linear, a joint with three
/// rotations turns by slerp. A joint with one or two rotations has its angles interpolated, the
/// shorter way round: a slerp would leave the turns that its channels can say.
class PoseInterpolation {
  public:
    explicit PoseInterpolation(const Skeleton& skeleton);

    /// The frame at `share` in [0, 1] of the way from `before` to `after`, into `between`, which
    /// may be either of them; all have skeleton.dof_count() values. Angles stay on the branch of
    /// the nearer frame.
    void operator()(std::span<const float> before, std::span<const float> after, double share,
                    std::span<float> between) const;

  private:
    /// The columns of a joint that turn together.
    struct Ball {
        std::array<int, 3> columns;  ///< by coordinate axis
        std::array<int, 3> order;    ///< axes, the one that acts first in front
    };
    static Eigen::Vector3d angles_of(const Ball& ball, std::span<const float> frame);
    static void turn(const Ball& ball, std::span<const float> before, std::span<const float> after,
                     double share, std::span<float> between);
    void add_joint(const Joint& joint, int first_dof);

    std::vector<Ball> balls_;
    std::vector<int> hinges_;  ///< angles of joints with one or two rotations
    std::vector<int> translations_;
};

}  // namespace kinetome
