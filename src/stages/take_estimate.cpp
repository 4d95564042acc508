#include "kinetome/stages/take_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinetome/base/error.h"
#include "kinetome/features/markers.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/resample.h"
#include "kinetome/models/compressed_motion.h"
#include "kinetome/models/estimation_score.h"
#include "kinetome/models/skeleton_fit.h"

namespace kinetome {
namespace {

std::span<const float> row_of(const MatrixF& rows, int64_t row) {
    return {rows.data() + row * rows.cols(), static_cast<size_t>(rows.cols())};
}

}  // namespace

ClassHierarchy model_for(const Generation& generation, const Clip& take) {
    const std::string wanted = take.skeleton->class_name();
    const ArtifactReader file = generation.open("pose_hierarchy.h5");
    const auto classes = hierarchy_classes(file);
    if (std::ranges::find(classes, wanted) == classes.end()) {
        throw UsageError(
            fmt::format("the take is of class {}, the store has models of {}: a model knows the "
                        "markers of its own class alone",
                        wanted, fmt::join(classes, ", ")));
    }
    return read_pose_hierarchy(file, "/" + wanted);
}

TakeEstimate estimate_take(const ClassHierarchy& model, const Clip& take, double blend_band) {
    if (take.frames() == 0) throw UsageError("the take has no frames");
    const PoseHierarchy& hierarchy = model.hierarchy;
    TakeEstimate result;
    result.take = resample(take, model.pose_rate);
    result.truth =
        normalised_markers(*take.skeleton, result.take.motion, joint_positions(result.take));
    result.poses.resize(result.truth.rows(), result.truth.cols());
    const int64_t markers = estimated_markers(model.principal, hierarchy.columns());
    double squared = 0;
    for (int64_t i = 0; i < result.truth.rows(); ++i) {
        const auto pose = row_of(result.truth, i);
        const VectorD principal = principal_values(hierarchy, pose);
        const VectorD estimate = estimate_pose(hierarchy, model.maps, principal, blend_band);
        result.poses.row(i) = estimate.transpose().cast<float>();
        result.errors.push_back(estimation_error(pose, estimate, markers));
        result.leaves.push_back(leaf_of(hierarchy, principal));
        squared += result.errors.back() * result.errors.back();
    }
    result.rms = std::sqrt(squared / static_cast<double>(result.errors.size()));
    return result;
}

Clip estimated_motion(const TakeEstimate& estimate) {
    const Clip& take = estimate.take;
    const MatrixD root = root_track(joint_positions(take), estimate.truth);
    const MatrixF positions = world_positions(estimate.poses, root);
    SkeletonFit fit(take.skeleton);
    // Only the root is known of the take's own angles: it stands as the take does.
    VectorF start = VectorF::Zero(take.motion.cols()), end = start;
    const auto root_dofs = static_cast<Eigen::Index>(take.skeleton->joints()[0].channels.size());
    start.head(root_dofs) = take.motion.row(0).head(root_dofs);
    end.head(root_dofs) = take.motion.row(take.frames() - 1).head(root_dofs);
    Clip motion = take;
    motion.motion = fit_frames(fit, positions, {start.data(), static_cast<size_t>(start.size())},
                               {end.data(), static_cast<size_t>(end.size())}, take.frames());
    return motion;
}

Table meter_table(const TakeEstimate& estimate) {
    Table table{{"frame", "error_mm", "leaf", "leaf_changes"}, {}};
    for (size_t i = 0; i < estimate.errors.size(); ++i) {
        const bool changes = i > 0 && estimate.leaves[i] != estimate.leaves[i - 1];
        table.rows.push_back({static_cast<int64_t>(i), estimate.errors[i],
                              int64_t{estimate.leaves[i]}, int64_t{changes}});
    }
    return table;
}

}  // namespace kinetome
