#include "kinetome/synthesis/body.h"

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "kinetome/formats/euler.h"
#include "kinetome/formats/joint_roles.h"

namespace kinetome {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double leg_spread = 20;  // degrees, in the rest pose
constexpr double arm_tilt = 30;    // degrees, of the elbow's axis in the rest pose

/// Writes the joints of one skeleton, parents first.
class SkeletonBuilder {
  public:
    /// `axes`: degrees about x, y, z, x acting first; `ranges`: degrees, one a channel.
    int add(const std::string& name, int parent, const Eigen::Vector3d& offset,
            const Eigen::Vector3d& axes, std::vector<Channel> channels,
            const std::vector<std::pair<double, double>>& ranges) {
        Joint joint;
        joint.name = name;
        joint.parent = parent;
        joint.offset_after = offset;
        joint.axes = rotation_from_euler(axes * degree, {0, 1, 2});
        joint.channels = std::move(channels);
        for (const auto& [low, high] : ranges)
            joint.limits.emplace_back(low * degree, high * degree);
        joints_.push_back(std::move(joint));
        return static_cast<int>(joints_.size()) - 1;
    }

    std::vector<Joint> take() { return std::move(joints_); }

  private:
    std::vector<Joint> joints_;
};

constexpr std::pair half_turn{-180.0, 180.0};

/// `side`: +1 left, -1 right. What is mirrored changes sign in x of offsets and in y and z of axes.
void add_leg(SkeletonBuilder& builder, const Body& body, int side) {
    using enum Channel;
    const std::string prefix = side > 0 ? "l" : "r";
    const Eigen::Vector3d spread(0, 0, side * leg_spread);
    const Eigen::Vector3d foot_axes(-90, 0, side * leg_spread);
    const double tilt = leg_spread * degree;
    const Eigen::Vector3d down(side * std::sin(tilt), -std::cos(tilt), 0);
    const int hip =
        builder.add(prefix + "hipjoint", 0, {side * body.hip_side, -body.hip_drop, body.hip_front},
                    Eigen::Vector3d::Zero(), {}, {});
    const int femur = builder.add(prefix + "femur", hip, down * body.thigh, spread, {rx, ry, rz},
                                  {{-160, 60}, {-90, 90}, {-90, 90}});
    const int tibia =
        builder.add(prefix + "tibia", femur, down * body.shin, spread, {rx}, {{-10, 170}});
    const Eigen::Vector3d sole =
        down * (body.ankle_height - body.ball_height) + Eigen::Vector3d(0, 0, body.foot);
    const int foot =
        builder.add(prefix + "foot", tibia, sole, foot_axes, {rx, rz}, {{-70, 90}, {-70, 70}});
    builder.add(prefix + "toes", foot, {0, 0, body.toes}, foot_axes, {rx}, {{-90, 30}});
}

int add_trunk(SkeletonBuilder& builder, const Body& body) {
    using enum Channel;
    const std::vector<Channel> turns = {rx, ry, rz};
    const std::vector<std::pair<double, double>> ranges = {{-50, 70}, {-50, 50}, {-45, 45}};
    const Eigen::Vector3d no_axes = Eigen::Vector3d::Zero();
    int parent = 0;
    for (const char* name : {"lowerback", "upperback", "thorax"})
        parent = builder.add(name, parent, {0, body.trunk_part, 0}, no_axes, turns, ranges);
    const int thorax = parent;
    for (const char* name : {"lowerneck", "upperneck"})
        parent = builder.add(name, parent, {0, body.neck_part, 0}, no_axes, turns, ranges);
    builder.add("head", parent, {0, body.head, 0}, no_axes, turns, ranges);
    return thorax;
}

void add_arm(SkeletonBuilder& builder, const Body& body, int thorax, int side) {
    using enum Channel;
    const std::string prefix = side > 0 ? "l" : "r";
    const Eigen::Vector3d arm_axes(180, -side * arm_tilt, -side * 90.0);
    const Eigen::Vector3d hand_axes(0, side * 90.0, side * 90.0);
    const Eigen::Vector3d out(side, 0, 0);
    const int clavicle =
        builder.add(prefix + "clavicle", thorax, {side * body.shoulder_side, body.shoulder_rise, 0},
                    Eigen::Vector3d::Zero(), {ry, rz}, {{-50, 50}, {-50, 50}});
    const int humerus = builder.add(prefix + "humerus", clavicle, out * body.upper_arm, arm_axes,
                                    {rx, ry, rz}, {half_turn, half_turn, half_turn});
    const int radius = builder.add(prefix + "radius", humerus, out * (body.forearm * 2 / 3),
                                   arm_axes, {rx}, {{-10, 170}});
    const int wrist = builder.add(prefix + "wrist", radius, out * (body.forearm / 3), hand_axes,
                                  {ry}, {half_turn});
    const int hand = builder.add(prefix + "hand", wrist, out * body.hand, hand_axes, {rx, rz},
                                 {{-90, 90}, {-60, 60}});
    builder.add(prefix + "fingers", hand, out * body.fingers, hand_axes, {rx}, {{-30, 120}});
    const Eigen::Vector3d thumb = Eigen::Vector3d(side, 0, 1).normalized();
    builder.add(prefix + "thumb", wrist, thumb * body.thumb, {-90, side * 45.0, 0}, {rx, rz},
                {{-60, 60}, {-60, 60}});
}

}  // namespace

Body::Body(double height)
    : thigh(0.245 * height),
      shin(0.246 * height),
      ankle_height(0.039 * height),
      ball_height(0.012 * height),
      foot(0.080 * height),
      toes(0.040 * height),
      hip_side(0.052 * height),
      hip_drop(0.054 * height),
      hip_front(0.016 * height),
      trunk_part(0.070 * height),
      neck_part(0.050 * height),
      head(0.052 * height),
      shoulder_side(0.115 * height),
      shoulder_rise(0.026 * height),
      upper_arm(0.172 * height),
      forearm(0.157 * height),
      hand(0.042 * height),
      fingers(0.035 * height),
      thumb(0.045 * height) {}

Body random_body(RandomStream& random) {
    Body body(174.0 + 9.0 * random.normal());
    const auto vary = [&random](double spread, std::initializer_list<double*> lengths) {
        const double factor = std::exp(spread * random.normal());
        for (double* length : lengths) *length *= factor;
    };
    vary(0.03, {&body.thigh, &body.shin});
    vary(0.02, {&body.shin});
    vary(0.04, {&body.foot, &body.toes, &body.ankle_height, &body.ball_height});
    vary(0.06, {&body.hip_side});
    vary(0.04, {&body.trunk_part});
    vary(0.04, {&body.neck_part, &body.head});
    vary(0.05, {&body.shoulder_side});
    vary(0.04, {&body.upper_arm, &body.forearm});
    vary(0.05, {&body.hand, &body.fingers, &body.thumb});
    return body;
}

Skeleton make_skeleton(const Body& body, std::string name) {
    using enum Channel;
    SkeletonBuilder builder;
    builder.add("root", -1, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                {tx, ty, tz, rx, ry, rz}, {});
    add_leg(builder, body, +1);
    add_leg(builder, body, -1);
    const int thorax = add_trunk(builder, body);
    add_arm(builder, body, thorax, +1);
    add_arm(builder, body, thorax, -1);
    Skeleton skeleton(std::move(name), builder.take());
    assign_roles(skeleton, skeleton.name());
    return skeleton;
}

}  // namespace kinetome
