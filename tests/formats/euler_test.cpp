#include "kinetome/formats/euler.h"

#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <numbers>
#include <random>

using namespace kinetome;

namespace {

constexpr double half_turn = std::numbers::pi;
constexpr std::array<std::array<int, 3>, 6> orders = {
    {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};

}  // namespace

TEST_CASE("the first axis of an order acts first") {
    const Eigen::Vector3d angles(0.3, -0.8, 1.9);
    const Eigen::Quaterniond x(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()));
    const Eigen::Quaterniond y(Eigen::AngleAxisd(-0.8, Eigen::Vector3d::UnitY()));
    const Eigen::Quaterniond z(Eigen::AngleAxisd(1.9, Eigen::Vector3d::UnitZ()));
    CHECK(rotation_from_euler(angles, {0, 1, 2}).isApprox((z * y * x).toRotationMatrix(), 1e-14));
    CHECK(rotation_from_euler(angles, {1, 2, 0}).isApprox((x * z * y).toRotationMatrix(), 1e-14));
}

TEST_CASE("angles survive the way through a rotation, in all six orders and any turn") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> angle(-3 * half_turn, 3 * half_turn);
    for (const std::array<int, 3>& order : orders) {
        for (int i = 0; i < 200; ++i) {
            const Eigen::Vector3d angles(angle(random), angle(random), angle(random));
            const Eigen::Vector3d found =
                euler_from_rotation(rotation_from_euler(angles, order), order, angles);
            CHECK((found - angles).norm() < 1e-6);
        }
    }
}

TEST_CASE("in gimbal lock, and close to it, the rotation is kept and the angles do not jump") {
    for (const std::array<int, 3>& order : orders) {
        for (const double from_lock : {0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6, 1e-3}) {
            Eigen::Vector3d angles(0.4, 0.4, 0.4);
            angles[order[1]] = half_turn / 2 - from_lock;
            // Turned there and back: rounding hides what the lock does not define.
            const Eigen::Matrix3d away = rotation_from_euler({0.7, -0.2, 1.1}, order);
            const Eigen::Matrix3d rotation =
                away.transpose() * (away * rotation_from_euler(angles, order));
            const Eigen::Vector3d near = angles + Eigen::Vector3d::Constant(0.01);
            const Eigen::Vector3d found = euler_from_rotation(rotation, order, near);
            CHECK((rotation_from_euler(found, order) - rotation).norm() < 1e-8);
            CHECK((found - near).norm() < 0.1);
        }
    }
}

TEST_CASE("an angle is brought within half a turn of another by whole turns") {
    CHECK(nearest_turn(0.1, 0.2) == 0.1);
    CHECK(nearest_turn(3.1, -3.1) == Approx(3.1 - 2 * half_turn));
    CHECK(nearest_turn(-0.5, 40 * half_turn) == Approx(40 * half_turn - 0.5));
}
