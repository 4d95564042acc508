// From a posture to the degrees of freedom of a performer's skeleton.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "kinetome/formats/skeleton.h"
#include "kinetome/synthesis/body.h"
#include "kinetome/synthesis/posture.h"

namespace kinetome {

/// The frame that feet, pelvis and travel refer to: a point on the floor and a heading.
struct TravelFrame {
    double x = 0, z = 0;  ///< cm
    double heading = 0;   ///< radians about the vertical; 0 faces +z, positive turns left

    /// Moves on by the posture's speeds for `seconds`.
    void advance(const Posture& posture, double leg_length, double seconds);
};

/// Solves postures frame by frame: legs by two-bone inverse kinematics that keeps the feet where
/// the posture puts them, all else directly. Angles are continuous from one call to the next.
class PostureSolver {
  public:
    /// `skeleton` must come from make_skeleton(body) and outlive the solver.
    PostureSolver(const Body& body, const Skeleton& skeleton);

    /// Fills `dofs` (skeleton.dof_count() values; cm and radians).
    void solve(const Posture& posture, const TravelFrame& travel, std::span<double> dofs);

  private:
    struct LegJoints {
        int femur, tibia, foot, toes;
    };
    struct ArmJoints {
        int clavicle, humerus, radius, wrist, hand, fingers, thumb;
    };

    void place_root(const Posture& posture, const TravelFrame& travel, std::span<double> dofs);
    void bend_trunk(const Posture& posture, std::span<double> dofs) const;
    void place_arm(Side side, const ValueTable<Arm>& arm, std::span<double> dofs);
    void place_leg(Side side, const ValueTable<Leg>& leg, const TravelFrame& travel,
                   std::span<double> dofs);
    /// Angles of a ball joint, the ones nearest to its angles in the frame before.
    void turn_ball(int first_dof, const Eigen::Matrix3d& rotation, std::span<double> dofs);

    Body body_;
    std::array<LegJoints, 2> legs_;  ///< first columns
    std::array<ArmJoints, 2> arms_;
    std::array<int, 3> back_, neck_;
    std::array<Eigen::Matrix3d, 2> femur_axes_, humerus_axes_;  ///< transposed
    std::vector<double> previous_;
    Eigen::Vector3d root_position_ = Eigen::Vector3d::Zero();
    Eigen::Matrix3d root_rotation_ = Eigen::Matrix3d::Identity();
};

}  // namespace kinetome
