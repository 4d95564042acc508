// A performer's body: segment lengths, and the skeleton they make.
#pragma once

#include <string>

#include "kinetome/base/random.h"
#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// Segment lengths in centimetres. The defaults are shares of the standing height as tabulated by
/// Drillis & Contini (1966; in Winter, Biomechanics and Motor Control of Human Movement).
struct Body {
    /// Mean proportions at a standing height in cm.
    explicit Body(double height = 174.0);

    double thigh, shin;   ///< hip to knee, knee to ankle
    double ankle_height;  ///< ankle above the sole
    double ball_height;   ///< base of the toes above the sole
    double foot;          ///< ankle to base of the toes, along the floor
    double toes;
    double hip_side, hip_drop, hip_front;  ///< from the root to the left hip
    double trunk_part;                     ///< each of the three joints between root and thorax
    double neck_part;                      ///< each of the two neck joints
    double head;
    double shoulder_side, shoulder_rise;  ///< from the thorax to the left shoulder
    double upper_arm;
    double forearm;  ///< elbow to wrist; two joints share it, the second one twists
    double hand, fingers, thumb;

    double leg() const { return thigh + shin; }
};

/// A body of random height (about 174 ± 9 cm) and slightly uneven proportions.
Body random_body(RandomStream& random);

/// CMU's scheme of 31 joints and 62 degrees of freedom: same names, parents, channels and order, so
/// that pose models are shared with CMU's takes; lengths are the body's. In the rest pose the arms
/// point sideways and the legs are spread by 20°. Left and right mirror each other.
Skeleton make_skeleton(const Body& body, std::string name);

}  // namespace kinetome
