#include "kinetome/formats/euler.h"

#include <cmath>
#include <numbers>

namespace kinetome {

Eigen::Matrix3d axis_rotation(int axis, double angle) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    rotation(u, u) = rotation(v, v) = std::cos(angle);
    rotation(v, u) = std::sin(angle);
    rotation(u, v) = -rotation(v, u);
    return rotation;
}

Eigen::Matrix3d rotation_from_euler(const Eigen::Vector3d& angles,
                                    const std::array<int, 3>& order) {
    return axis_rotation(order[2], angles[order[2]]) * axis_rotation(order[1], angles[order[1]]) *
           axis_rotation(order[0], angles[order[0]]);
}

double nearest_turn(double angle, double near) {
    constexpr double turn = 2 * std::numbers::pi;
    return angle - turn * std::nearbyint((angle - near) / turn);
}

Eigen::Vector3d euler_from_rotation(const Eigen::Matrix3d& rotation,
                                    const std::array<int, 3>& order, const Eigen::Vector3d& near) {
    const auto [first, second, third] = order;
    const double sign = (first + 1) % 3 == second ? 1.0 : -1.0;  // an even or an odd order

    // Row `third` of R = R₃(c)·R₂(b)·R₁(a) is (∓sin b, ± cos b sin a, cos b cos a): it gives a, but
    // for half a turn; b and c are then those of R·R₁(a)ᵀ = R₃(c)·R₂(b), whatever b is.
    const double sine = sign * rotation(third, second);
    const double cosine = rotation(third, third);
    constexpr double locked = 1e-9;
    const double angle = std::hypot(sine, cosine) > locked ? std::atan2(sine, cosine) : near[first];

    Eigen::Vector3d best;
    double best_distance = HUGE_VAL;
    for (const double half_turn : {0.0, std::numbers::pi}) {
        Eigen::Vector3d angles;
        angles[first] = nearest_turn(angle + half_turn, near[first]);
        const Eigen::Matrix3d rest = rotation * axis_rotation(first, -angles[first]);
        const double b = std::atan2(-sign * rest(third, first), rest(third, third));
        const double c = std::atan2(-sign * rest(first, second), rest(second, second));
        angles[second] = nearest_turn(b, near[second]);
        angles[third] = nearest_turn(c, near[third]);
        const double distance = (angles - near).squaredNorm();
        if (distance < best_distance) {
            best_distance = distance;
            best = angles;
        }
    }
    return best;
}

}  // namespace kinetome
