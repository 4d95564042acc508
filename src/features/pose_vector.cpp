#include "kinetome/features/pose_vector.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

#include "clip_rows.h"
#include "kinetome/features/root_motion.h"
#include "kinetome/math/quantiles.h"

namespace kinetome {

namespace {

constexpr double full_turn = 2 * std::numbers::pi;
constexpr double radians(double degrees) {
    return degrees * std::numbers::pi / 180;
}

/// Columns of a motion that are angles of joints below the root.
std::vector<int> joint_angle_dofs(const Skeleton& skeleton) {
    const RootChain chain(skeleton);
    std::vector<int> dofs;
    for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
        if (chain.contains(joint)) continue;
        const auto& channels = skeleton.joints()[static_cast<size_t>(joint)].channels;
        for (size_t i = 0; i < channels.size(); ++i)
            if (is_rotation(channels[i]))
                dofs.push_back(skeleton.first_dof(joint) + static_cast<int>(i));
    }
    return dofs;
}

/// Removes jumps of whole turns between successive angles.
void unwrap(std::span<double> angles) {
    for (size_t i = 1; i < angles.size(); ++i)
        angles[i] -= full_turn * std::round((angles[i] - angles[i - 1]) / full_turn);
}

/// Clips of one class then agree on the turn they count from.
void shift_median_towards_zero(std::span<double> angles) {
    const double median = lower_quantile(std::vector(angles.begin(), angles.end()), 0.5);
    const double shift = full_turn * std::round(median / full_turn);
    for (double& angle : angles) angle -= shift;
}

void write_joint_angles(const Skeleton& skeleton, const MatrixFView& motion, MatrixF& vectors) {
    std::vector<double> angles(static_cast<size_t>(motion.rows()));
    Eigen::Index column = 0;
    for (const int dof : joint_angle_dofs(skeleton)) {
        for (Eigen::Index i = 0; i < motion.rows(); ++i)
            angles[static_cast<size_t>(i)] = double{motion(i, dof)};
        unwrap(angles);
        shift_median_towards_zero(angles);
        for (Eigen::Index i = 0; i < motion.rows(); ++i)
            vectors(i, column) = static_cast<float>(angles[static_cast<size_t>(i)]);
        ++column;
    }
}

/// The root along a clip, one entry a frame.
struct RootPath {
    std::vector<Eigen::Vector3d> position;  ///< cm
    std::vector<double> yaw;                ///< unwrapped
    std::vector<double> pitch;
    std::vector<double> roll;
};

RootPath root_path(const Skeleton& skeleton, const MatrixFView& motion) {
    const RootChain chain(skeleton);
    RootPath path;
    for (Eigen::Index i = 0; i < motion.rows(); ++i) {
        const RootPose pose = chain.pose(frame_of(motion, i));
        const RootAngles angles = root_angles(pose.rotation);
        path.position.push_back(pose.position);
        path.yaw.push_back(angles.yaw);
        path.pitch.push_back(angles.pitch);
        path.roll.push_back(angles.roll);
    }
    unwrap(path.yaw);
    return path;
}

void write_root_columns(const RootPath& path, double rate, int64_t reach, MatrixF& vectors) {
    const auto frames = static_cast<int64_t>(path.yaw.size());
    const Eigen::Index column = vectors.cols() - 6;
    for (int64_t i = 0; i < frames; ++i) {
        const auto frame = static_cast<size_t>(i);
        const auto before = static_cast<size_t>(std::max<int64_t>(i - reach, 0));
        const auto after = static_cast<size_t>(std::min(i + reach, frames - 1));
        const double per_second = after > before ? rate / static_cast<double>(after - before) : 0.0;
        const Eigen::Vector3d velocity =
            per_second * (path.position[after] - path.position[before]);
        const double sine = std::sin(path.yaw[frame]), cosine = std::cos(path.yaw[frame]);
        const double columns[] = {path.position[frame].y(),
                                  path.pitch[frame],
                                  path.roll[frame],
                                  sine * velocity.x() + cosine * velocity.z(),
                                  cosine * velocity.x() - sine * velocity.z(),
                                  per_second * (path.yaw[after] - path.yaw[before])};
        for (Eigen::Index c = 0; c < 6; ++c)
            vectors(i, column + c) = static_cast<float>(columns[c]);
    }
}

}  // namespace

std::vector<PoseVectorColumn> pose_vector_columns(const Skeleton& skeleton) {
    const std::vector<std::string> names = skeleton.dof_names();
    std::vector<PoseVectorColumn> columns;
    for (const int dof : joint_angle_dofs(skeleton))
        columns.push_back({names[static_cast<size_t>(dof)], "rad", radians(5)});
    columns.push_back({"root height", "cm", 1.0});
    columns.push_back({"root pitch", "rad", radians(5)});
    columns.push_back({"root roll", "rad", radians(5)});
    columns.push_back({"forward velocity", "cm/s", 5.0});
    columns.push_back({"lateral velocity", "cm/s", 5.0});
    columns.push_back({"yaw speed", "rad/s", radians(10)});
    return columns;
}

MatrixF pose_vectors(const Skeleton& skeleton, const MatrixFView& motion, double rate,
                     double velocity_reach) {
    require_motion_of(skeleton, motion);
    if (!(rate > 0)) throw std::invalid_argument("pose vectors need a positive frame rate");
    const auto columns = static_cast<Eigen::Index>(joint_angle_dofs(skeleton).size()) + 6;
    const int64_t reach = std::max<int64_t>(std::llround(velocity_reach * rate), 1);

    MatrixF vectors(motion.rows(), columns);
    write_joint_angles(skeleton, motion, vectors);
    write_root_columns(root_path(skeleton, motion), rate, reach, vectors);
    return vectors;
}

}  // namespace kinetome
