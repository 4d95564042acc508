#include "kinetome/math/point_cloud.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

MatrixF random_clouds(int64_t clouds, int64_t points, uint64_t seed) {
    RandomStream random(seed, "point clouds");
    MatrixF rows(clouds, 3 * points);
    for (float& value : rows.reshaped<Eigen::RowMajor>()) value = float(50 * random.normal());
    return rows;
}

MatrixF turned_and_moved(const MatrixF& clouds, double angle, const Eigen::Vector3d& by) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
    MatrixF moved = clouds;
    for (int64_t i = 0; i < clouds.rows(); ++i) {
        for (int64_t p = 0; p < clouds.cols(); p += 3) {
            const Eigen::Vector3d point = clouds.block<1, 3>(i, p).transpose().cast<double>();
            moved.block<1, 3>(i, p) = (turn * point + by).cast<float>().transpose();
        }
    }
    return moved;
}

}  // namespace

TEST_CASE("a cloud is at no distance from itself elsewhere on the floor, facing elsewhere") {
    const MatrixF clouds = random_clouds(3, 7, 1);
    const MatrixF moved = turned_and_moved(clouds, 2.1, {300, 0, -120});
    const MatrixD distances = point_cloud_distances(clouds, moved);
    for (int64_t i = 0; i < 3; ++i) {
        for (int64_t j = 0; j < 3; ++j) {
            CHECK((distances(i, j) < 1e-2) == (i == j));
        }
    }
}

TEST_CASE("a cloud that is higher is as far away as it is higher") {
    const MatrixF clouds = random_clouds(1, 7, 2);
    const MatrixF higher = turned_and_moved(clouds, 0.4, {0, 12, 0});
    CHECK(point_cloud_distances(clouds, higher)(0, 0) == Approx(12).epsilon(1e-4));
}

TEST_CASE("no turn and no place on the floor brings two clouds nearer") {
    const MatrixF first = random_clouds(1, 5, 3), second = random_clouds(1, 5, 4);
    const double distance = point_cloud_distances(first, second)(0, 0);
    // Whatever the turn, the best place has the middles above each other.
    double best = std::numeric_limits<double>::infinity();
    const auto middle = [](const MatrixF& cloud) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int64_t p = 0; p < 15; p += 3) {
            sum += cloud.block<1, 3>(0, p).transpose().cast<double>();
        }
        return Eigen::Vector3d(sum.x() / 5, 0, sum.z() / 5);
    };
    for (int step = 0; step < 3600; ++step) {
        const MatrixF turned =
            turned_and_moved(second, step * std::numbers::pi / 1800, Eigen::Vector3d::Zero());
        const MatrixF placed =
            turned_and_moved(turned, 0, Eigen::Vector3d(middle(first) - middle(turned)));
        best = std::min(best, double((placed - first).norm()) / std::sqrt(5.0));
    }
    CHECK(distance == Approx(best).epsilon(1e-4));
    CHECK(distance <= best * (1 + 1e-6));
}

TEST_CASE("clouds of other sizes are refused") {
    CHECK_THROWS_AS(point_cloud_distances(MatrixF(1, 6), MatrixF(1, 9)), std::invalid_argument);
    CHECK_THROWS_AS(point_cloud_distances(MatrixF(1, 4), MatrixF(1, 4)), std::invalid_argument);
    CHECK(point_cloud_distances(MatrixF(0, 6), MatrixF(2, 6)).size() == 0);
}
