// Motion as coordinates on the leaves of a pose hierarchy (S2 §5.1), in blocks that are decoded
// apart from each other.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/pose_hierarchy.h"

namespace kinetome {

/// Steps that numbers are rounded to: far below what the leaves leave out.
struct MotionSteps {
    double coordinate = 0.05;  ///< cm
    double place = 0.01;       ///< cm
    double heading = 1e-4;     ///< radians
};

/// The linear models of some leaves, rounded as they are stored.
class LeafModels {
  public:
    LeafModels() = default;
    /// Of the leaves of a hierarchy with these numbers, ascending.
    LeafModels(const PoseHierarchy& hierarchy, std::vector<int32_t> leaves);
    /// Out of bytes(). Throws std::out_of_range when they end too early.
    explicit LeafModels(std::string_view bytes);

    std::string bytes() const;
    const std::vector<int32_t>& leaves() const { return leaves_; }  ///< their numbers
    int64_t size() const { return means_.rows(); }
    int64_t columns() const { return means_.cols(); }
    int64_t dimension() const { return dimension_; }

    /// Of a pose (f) on the i-th model, cm.
    VectorD coordinates(int64_t model, std::span<const float> pose) const;
    /// And back, cm.
    VectorD pose(int64_t model, const VectorD& coordinates) const;

  private:
    int64_t dimension_ = 0;
    std::vector<int32_t> leaves_;
    MatrixD means_;  ///< models × f, cm
    MatrixD bases_;  ///< models f × d
};

/// Where the body is, of each frame: x, y, z of the root (cm) and the heading (radians, unwrapped)
/// that normalised markers are turned by, n × 4.
MatrixD root_track(const MatrixFView& positions, const MatrixFView& normalised);

/// World positions of normalised poses: turned by the heading and moved to the root's place.
MatrixF world_positions(const MatrixFView& normalised, const MatrixDView& root);

/// Frames as they are stored.
struct LeafFrames {
    std::vector<int32_t> models;  ///< n, which of the leaf models
    MatrixD coordinates;          ///< n × d, cm
    MatrixD root;                 ///< n × 4
};

/// Poses (n × f, cm) on the models of the leaves they fall in.
LeafFrames on_leaves(const PoseHierarchy& hierarchy, const LeafModels& models,
                     const MatrixFView& poses, const MatrixDView& root);

/// Runs of models, then rounded numbers as differences from their straight continuation (inside a
/// run), each in as few bytes as it needs.
std::string encode_block(const LeafFrames& frames, const MotionSteps& steps);
/// Throws std::out_of_range for bytes that no block ends with or that name a model there is none
/// of.
LeafFrames decode_block(std::string_view bytes, const LeafModels& models, const MotionSteps& steps);

/// Frames that one blend reaches to either side of a change of leaf.
struct LeafBlend {
    int64_t frames = 6;  ///< at most; half of a shorter run

    /// Frames beyond a range that what is seen in the range depends on.
    int64_t margin() const { return 2 * frames + 2; }
};

/// Poses (n × f, cm) of frames. Where the leaf changes, the leap from the straight continuation of
/// one side to the other's is taken half by each, fading with distance: two linear models meet
/// badly, and we are very sensitive to jerks (S2 §4).
MatrixF poses_of(const LeafFrames& frames, const LeafModels& models, const LeafBlend& blend);

/// Mm per marker of each frame (pose_error).
struct PoseErrors {
    double rms = 0;
    double mean = 0;
    double share_95 = 0;  ///< 95 % of the frames are no worse
    double greatest = 0;
};

PoseErrors pose_errors(const MatrixFView& poses, const MatrixFView& decoded);
PoseErrors summary_of(std::vector<double> errors);
/// Of each frame.
std::vector<double> errors_of(const MatrixFView& poses, const MatrixFView& decoded);

}  // namespace kinetome
