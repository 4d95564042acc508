// Angles of a skeleton whose joints are to be at given places.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/clip.h"
#include "kinetome/formats/kinematics.h"

namespace kinetome {

struct SkeletonFitOptions {
    double rest = 0.5;    ///< cm that a joint may be off rather than an angle be a radian away
                          ///< from where it rests: places do not tell how a straight limb is
                          ///< turned about itself
    int iterations = 8;   ///< at most
    double close = 1e-4;  ///< radians or cm: steps that are smaller are the last
};

/// Fits one skeleton to many frames.
class SkeletonFit {
  public:
    explicit SkeletonFit(std::shared_ptr<const Skeleton> skeleton,
                         const SkeletonFitOptions& options = {});

    /// Degrees of freedom (cm, radians) that minimise the squared distances of all joints to
    /// `positions` (3 · joint_count, cm) and, far behind, of angles to `rest`: by Levenberg and
    /// Marquardt's method from `dofs`, which are replaced. Returns what is left of that sum. Throws
    /// std::invalid_argument for other sizes.
    double fit(std::span<const float> positions, std::span<const float> rest,
               std::span<float> dofs);

  private:
    /// Joints minus targets_, then weighted angles minus rest_: (3 · joint_count + dof_count).
    void residuals(std::span<const float> dofs, VectorD& result);
    /// What `at`, the residuals of `dofs`, say of the next step: slopesᵀ · slopes (its lower
    /// triangle) and slopesᵀ · at.
    void differentiate(std::span<const float> dofs, const VectorD& at);

    std::shared_ptr<const Skeleton> skeleton_;
    SkeletonFitOptions options_;
    KinematicChain chain_;
    Pose pose_;
    std::vector<DofMotion> motions_;
    VectorD targets_, rest_;
    VectorD weights_;  ///< of each degree of freedom's own distance from rest
    MatrixD slopes_;   ///< dof_count × 3 · joint_count, cm a radian or cm: of joints alone
    MatrixD normal_;   ///< dof_count × dof_count
    VectorD gradient_;
};

/// All frames of positions (n × 3 · joint_count): each from the one before, the first from `start`;
/// angles rest where a straight line from `start` to `end` (both dof_count values) leads, which is
/// reached after `frames` frames.
MatrixF fit_frames(SkeletonFit& fit, const MatrixFView& positions, std::span<const float> start,
                   std::span<const float> end, int64_t frames);

}  // namespace kinetome
