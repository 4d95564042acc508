// Motion put together frame by frame from several clips at once, going on where it stands.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "kinetome/features/placement.h"
#include "kinetome/formats/clip.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/pose_interpolation.h"
#include "kinetome/models/foot_contacts.h"

namespace kinetome {

/// What one clip gives to one frame. Moments are frames of the clip and need not be whole; before
/// its first and after its last frame the pose is held and the root goes on as it moves there.
struct MotionShare {
    const Clip* clip = nullptr;
    double moment = 0;
    double moment_before = 0;  ///< what it would give to the frame before
    double weight = 1;         ///< of all shares' weights, which need not add up to 1
    FootSupport support = {};  ///< how firmly the clip's feet stand at the moment
};

/// Joints, height and tilt of a frame are blended pose by pose (PoseInterpolation, in the order of
/// the shares); place and heading on the floor are not: the root's steps are, as seen from the
/// root, and each frame is one step from the last. So no clip needs to be moved where another one
/// stands, and a blend of equal clips is that clip.
///
/// A foot that stands in all clips slides in their blend: it goes from where the one has it under
/// the body to where the other has it. The body gives way instead, as far as feet stand: each step
/// of the root is altered by the mean of what the blend adds to the steps of standing feet.
class MotionBlend {
  public:
    /// All clips are of this skeleton. Throws std::invalid_argument when its root is not free to go
    /// anywhere (RootChain::is_free).
    MotionBlend(std::shared_ptr<const Skeleton> skeleton, double rate);

    /// The next frame. The first one stands where its first share's clip does. Throws
    /// std::invalid_argument for a clip without frames or with another number of columns, for
    /// moments that are not finite, for weights that are negative or all zero.
    void append(std::span<const MotionShare> shares);

    int64_t frames() const { return static_cast<int64_t>(rows_.size()); }
    /// All frames so far.
    Clip clip() const;

  private:
    using Row = std::vector<float>;
    void check(std::span<const MotionShare> shares) const;
    /// The clip at any moment, standing at the origin and facing along +z.
    Row centred_pose(const Clip& clip, double moment) const;
    Placement placement(const Clip& clip, double moment) const;
    /// What the blend's feet go along the floor beyond what the shares' feet do, in the mean of
    /// those that stand; as seen from the frame before. `pose` is centred, `step` the root's.
    Eigen::Vector3d slide(std::span<const MotionShare> shares, const Row& pose,
                          const Placement& step) const;
    using Feet = std::array<Eigen::Vector3d, foot_roles.size()>;
    Feet feet(const Row& centred, const Placement& placement) const;

    std::shared_ptr<const Skeleton> skeleton_;
    double rate_;
    RootChain root_;
    KinematicChain chain_;
    PoseInterpolation interpolate_;
    Placement placement_;
    std::vector<Row> rows_;
};

/// Frames of a clip as one of several to be blended: [first, end).
struct BlendPart {
    const Clip* clip = nullptr;
    int64_t first = 0, end = 0;
    double weight = 1;
    /// Shares of this part, ascending from 0 to 1, that answer even shares of what all parts are
    /// registered to; empty: the same ones.
    std::vector<double> registration = {};
    std::span<const FootSupport> support = {};  ///< of the clip's frames; none: feet are not held
};

/// All parts at once from beginning to end, each passing what answers the others at the same time:
/// time passes as fast as in the weighted mean of the parts, so that the blend is as long as the
/// weighted mean of their lengths, rounded, at least a frame. Throws what MotionBlend throws, and
/// std::invalid_argument for parts of different rates, registrations that do not ascend from 0 to 1
/// or no part.
Clip blend_motions(std::span<const BlendPart> parts);

}  // namespace kinetome
