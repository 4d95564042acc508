#include "kinetome/synthesis/posture.h"

#include <utility>

namespace kinetome {

Posture& Posture::operator+=(const Posture& other) {
    trunk += other.trunk;
    for (const Side side : both_sides) {
        arm(side) += other.arm(side);
        leg(side) += other.leg(side);
    }
    return *this;
}

Posture mix(const Posture& a, const Posture& b, double weight) {
    Posture mixed;
    mixed.trunk = mix(a.trunk, b.trunk, weight);
    for (const Side side : both_sides) {
        mixed.arm(side) = mix(a.arm(side), b.arm(side), weight);
        mixed.leg(side) = mix(a.leg(side), b.leg(side), weight);
    }
    return mixed;
}

Posture mirrored(const Posture& posture) {
    Posture image = posture;
    std::swap(image.arm(Side::left), image.arm(Side::right));
    std::swap(image.leg(Side::left), image.leg(Side::right));
    using enum Trunk;
    for (const Trunk control : {pelvis_shift, pelvis_yaw, pelvis_roll, spine_twist, spine_lean,
                                neck_twist, neck_lean, side_speed, turn_rate})
        image[control] = -image[control];
    return image;
}

}  // namespace kinetome
