#include "kinetome/features/pose_vector.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "kinetome/formats/euler.h"
#include "small_body.h"
#include "support/cmu_take.h"
#include "support/test_corpus.h"

using namespace kinetome;

namespace {

constexpr double full_turn = 2 * std::numbers::pi;

/// Columns after the joint angles.
enum RootColumn { height, pitch, roll, forward, lateral, yaw_speed };

float root_value(const MatrixF& vectors, Eigen::Index frame, RootColumn column) {
    return vectors(frame, vectors.cols() - 6 + column);
}

MatrixF standing(int frames) {
    return MatrixF::Zero(frames, small_body::skeleton().dof_count());
}

float largest_difference(const MatrixF& a, const MatrixF& b) {
    REQUIRE(a.rows() == b.rows());
    REQUIRE(a.cols() == b.cols());
    return (a - b).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a skeleton with 56 joint angles has 62 columns, each with its unit and floor") {
    std::vector<Joint> joints = {small_body::bone("root", -1, {0, 0, 0}, small_body::turn_last)};
    for (int joint = 1; joint <= 18; ++joint)
        joints.push_back(small_body::bone(("bone" + std::to_string(joint)).c_str(), joint - 1,
                                          {0, 10, 0}, small_body::three_angles));
    joints.push_back(small_body::bone("foot", 3, {0, 0, 9}, {Channel::rx, Channel::rz}));
    const auto columns = pose_vector_columns(Skeleton("62", joints));

    REQUIRE(columns.size() == 62);
    const double degree = full_turn / 360;
    CHECK(columns[0].name == "bone1.rx");
    CHECK(columns[55].name == "foot.rz");
    for (size_t c = 0; c < 56; ++c) {
        CHECK(columns[c].unit == "rad");
        CHECK(columns[c].floor == Approx(5 * degree));
    }
    const struct {
        const char* name;
        const char* unit;
        double floor;
    } of_root[] = {{"root height", "cm", 1},         {"root pitch", "rad", 5 * degree},
                   {"root roll", "rad", 5 * degree}, {"forward velocity", "cm/s", 5},
                   {"lateral velocity", "cm/s", 5},  {"yaw speed", "rad/s", 10 * degree}};
    for (size_t c = 0; c < 6; ++c) {
        CHECK(columns[56 + c].name == of_root[c].name);
        CHECK(columns[56 + c].unit == of_root[c].unit);
        CHECK(columns[56 + c].floor == Approx(of_root[c].floor));
    }
}

TEST_CASE("a pose vector forgets where the body is and which way it faces") {
    const Skeleton body = small_body::skeleton();
    const MatrixF motion = small_body::wandering(400);
    const MatrixF vectors = pose_vectors(body, motion, 120);
    for (const double angle : {0.0, 0.7, std::numbers::pi, -2.5, 40.0}) {
        CAPTURE(angle);
        const MatrixF elsewhere = small_body::turned_and_moved(motion, angle, 130, -75);
        // A step of a float at these distances is 3e-5 cm, hence 1e-3 cm/s over four frames.
        CHECK(largest_difference(vectors, pose_vectors(body, elsewhere, 120)) < 5e-3F);
    }
}

TEST_CASE("height, pitch, roll and joint angles are those of the motion") {
    const MatrixF motion = small_body::wandering(200);
    const MatrixF vectors = pose_vectors(small_body::skeleton(), motion, 120);
    REQUIRE(vectors.cols() == 15 + 6);
    CHECK(largest_difference(vectors.leftCols(15), motion.rightCols(15)) < 1e-6F);
    for (Eigen::Index i = 0; i < motion.rows(); ++i) {
        CHECK(root_value(vectors, i, height) == motion(i, small_body::root_y));
        CHECK(root_value(vectors, i, pitch) ==
              Approx(motion(i, small_body::root_pitch)).margin(1e-6));
        CHECK(root_value(vectors, i, roll) ==
              Approx(motion(i, small_body::root_roll)).margin(1e-6));
    }
}

TEST_CASE("the order of the root's rotation channels does not change the pose vectors") {
    const MatrixF motion = small_body::wandering(300);
    MatrixF reordered = motion;
    Eigen::Vector3d near = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < motion.rows(); ++i) {
        const Eigen::Vector3d angles = {double{motion(i, small_body::root_pitch)},
                                        double{motion(i, small_body::root_yaw)},
                                        double{motion(i, small_body::root_roll)}};
        const Eigen::Matrix3d rotation =
            axis_rotation(1, angles[1]) * axis_rotation(0, angles[0]) * axis_rotation(2, angles[2]);
        near = euler_from_rotation(rotation, {0, 1, 2}, near);
        reordered.row(i).segment<3>(3) = near.transpose().cast<float>();
    }
    const Skeleton x_first = small_body::skeleton(
        {Channel::tx, Channel::ty, Channel::tz, Channel::rx, Channel::ry, Channel::rz});
    CHECK(largest_difference(pose_vectors(small_body::skeleton(), motion, 120),
                             pose_vectors(x_first, reordered, 120)) < 1e-4F);
}

TEST_CASE("a body that walks ahead moves forward only, one that steps left sideways only") {
    constexpr double speed = 100, rate = 120;
    const double heading = GENERATE(0.0, 0.5, 1.6, -2.9);
    const double step = GENERATE(0.0, std::numbers::pi / 2);  // +90°: to the left of the heading
    MatrixF motion = standing(60);
    for (int i = 0; i < 60; ++i) {
        motion(i, small_body::root_x) =
            static_cast<float>(speed * i / rate * std::sin(heading + step));
        motion(i, small_body::root_z) =
            static_cast<float>(speed * i / rate * std::cos(heading + step));
        motion(i, small_body::root_yaw) = static_cast<float>(heading);
    }
    const MatrixF vectors = pose_vectors(small_body::skeleton(), motion, rate);
    for (int i = 0; i < 60; ++i) {
        CHECK(root_value(vectors, i, forward) == Approx(speed * std::cos(step)).margin(1e-2));
        CHECK(root_value(vectors, i, lateral) == Approx(speed * std::sin(step)).margin(1e-2));
        CHECK(root_value(vectors, i, yaw_speed) == Approx(0).margin(1e-5));
    }
}

TEST_CASE("a body that spins past half a turn keeps its yaw speed") {
    constexpr double speed = 4, rate = 120;
    MatrixF motion = standing(400);
    for (int i = 0; i < 400; ++i)
        motion(i, small_body::root_yaw) =
            static_cast<float>(std::remainder(speed * i / rate, full_turn));
    const MatrixF vectors = pose_vectors(small_body::skeleton(), motion, rate);
    for (int i = 0; i < 400; ++i)
        CHECK(root_value(vectors, i, yaw_speed) == Approx(speed).margin(1e-3));
}

TEST_CASE("velocity reach is in seconds, whatever the rate") {
    // Of t³ the difference over h to either side is 3t² + h²: it tells h.
    const double rate = GENERATE(30.0, 60.0, 120.0, 240.0);
    MatrixF motion = standing(static_cast<int>(rate) + 1);
    for (Eigen::Index i = 0; i < motion.rows(); ++i) {
        const double t = static_cast<double>(i) / rate - 0.5;
        motion(i, small_body::root_z) = static_cast<float>(1000 * t * t * t);
    }
    const auto middle = static_cast<Eigen::Index>(rate / 2);
    const Skeleton body = small_body::skeleton();
    const double least = 1 / rate;
    const MatrixF short_reach = pose_vectors(body, motion, rate, 2.0 / 120);
    CHECK(root_value(short_reach, middle, forward) ==
          Approx(1000 * std::pow(std::max(2.0 / 120, least), 2)).epsilon(1e-3));
    const MatrixF long_reach = pose_vectors(body, motion, rate, 0.1);
    CHECK(root_value(long_reach, middle, forward) == Approx(1000 * 0.01).epsilon(1e-3));
}

TEST_CASE("velocities at the ends of a clip look inside it only") {
    MatrixF motion = standing(5);
    const float path[] = {0, 1, 3, 6, 10};
    for (int i = 0; i < 5; ++i) motion(i, small_body::root_z) = path[i];
    const MatrixF vectors = pose_vectors(small_body::skeleton(), motion, 1, 2);
    const double expected[] = {3.0 / 2, 6.0 / 3, 10.0 / 4, 9.0 / 3, 7.0 / 2};
    for (int i = 0; i < 5; ++i) CHECK(root_value(vectors, i, forward) == Approx(expected[i]));
}

TEST_CASE("a clip of one frame has no velocity, a clip of none no vectors") {
    const Skeleton body = small_body::skeleton();
    const MatrixF one = pose_vectors(body, small_body::wandering(40).middleRows(30, 1), 120);
    REQUIRE(one.rows() == 1);
    CHECK(one.allFinite());
    for (const RootColumn column : {forward, lateral, yaw_speed})
        CHECK(root_value(one, 0, column) == 0);

    const MatrixF none = pose_vectors(body, small_body::wandering(0), 120);
    CHECK(none.rows() == 0);
    CHECK(none.cols() == static_cast<Eigen::Index>(pose_vector_columns(body).size()));
}

TEST_CASE("joint angles written with jumps of a whole turn come out continuous, about zero") {
    const MatrixF motion = small_body::wandering(300);
    const Skeleton body = small_body::skeleton();
    MatrixF jumping = motion;
    for (Eigen::Index i = 0; i < motion.rows(); ++i) {
        jumping(i, 7) += static_cast<float>(full_turn);                  // a clip's own offset
        if (i % 3 == 0) jumping(i, 9) -= static_cast<float>(full_turn);  // wrapped here, not there
        if (i >= 150) jumping(i, 12) += static_cast<float>(2 * full_turn);  // wound up halfway
    }
    const MatrixF expected = pose_vectors(body, motion, 120);
    MatrixF actual = pose_vectors(body, jumping, 120);
    CHECK(largest_difference(expected, actual) < 1e-5F);
}

TEST_CASE("an angle that passes half a turn is not cut there") {
    MatrixF motion = standing(100);
    for (int i = 0; i < 100; ++i)
        motion(i, 6) = static_cast<float>(std::remainder(2.0 + 0.02 * i, full_turn));
    const MatrixF vectors = pose_vectors(small_body::skeleton(), motion, 120);
    for (int i = 0; i < 100; ++i) CHECK(vectors(i, 0) == Approx(2.0 + 0.02 * i).epsilon(1e-5));
}

TEST_CASE("translations of joints below the root are no part of a pose vector") {
    std::vector<Joint> joints = {small_body::bone("root", -1, {0, 0, 0}, small_body::turn_last),
                                 small_body::bone("spine", 0, {0, 20, 0}, small_body::turn_last)};
    const Skeleton body("six channels a joint", joints);
    const auto columns = pose_vector_columns(body);
    REQUIRE(columns.size() == 3 + 6);
    CHECK(columns[0].name == "spine.rz");

    MatrixF motion = MatrixF::Zero(1, 12);
    motion.row(0).tail(6) << 7, 8, 9, 0.1F, 0.2F, 0.3F;
    const MatrixF vectors = pose_vectors(body, motion, 120);
    CHECK(vectors.row(0).head(3).isApprox(motion.row(0).tail(3)));
}

TEST_CASE("a reference joint above the root moves it but is no pose") {
    // The reference stands where and as the root stood; the root keeps height, pitch and roll, and
    // its offset undoes that of the reference.
    Joint reference = small_body::bone("reference", -1, {4, 5, 30},
                                       {Channel::tx, Channel::ty, Channel::tz, Channel::ry});
    Joint hips = small_body::bone("hips", 0, {0, 0, 0}, {Channel::ty, Channel::rz, Channel::rx});
    hips.offset_before = -reference.offset_after;
    Joint head = small_body::bone("head", 1, {0, 70, 5}, small_body::three_angles);
    Skeleton rig("rig", {reference, hips, head});
    rig.set_role(JointRole::root, 1);

    Skeleton plain("plain", {small_body::bone("root", -1, {0, 0, 0}, small_body::turn_last),
                             small_body::bone("head", 0, {0, 70, 5}, small_body::three_angles)});
    const MatrixF motion = small_body::wandering(200).leftCols(9);
    MatrixF of_rig(200, 10);
    of_rig << motion.col(0), MatrixF::Constant(200, 1, 10), motion.col(2), motion.col(5),
        motion.col(1).array() - 10, motion.col(3), motion.col(4), motion.rightCols(3);
    CHECK(largest_difference(pose_vectors(plain, motion, 120), pose_vectors(rig, of_rig, 120)) <
          1e-4F);
}

TEST_CASE("motion of another skeleton is refused") {
    const Skeleton body = small_body::skeleton();
    CHECK_THROWS_AS(pose_vectors(body, MatrixF::Zero(3, body.dof_count() - 1), 120),
                    std::invalid_argument);
    CHECK_THROWS_AS(pose_vectors(body, standing(3), 0), std::invalid_argument);
}

TEST_CASE("CMU's skeleton has 62 columns") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    const Clip take = cmu_take(*corpus, "02_01");
    const MatrixF vectors = pose_vectors(*take.skeleton, take.motion, take.rate);
    CHECK(vectors.rows() == take.frames());
    CHECK(vectors.cols() == 62);
    CHECK(pose_vector_columns(*take.skeleton).size() == 62);
    CHECK(vectors.allFinite());
}
