// A small rig with what makes ASF hard: axes, bones without freedom, one and two rotations.
#pragma once

#include <cmath>
#include <memory>
#include <string>

#include "kinetome/formats/asf_amc.h"
#include "kinetome/formats/clip.h"

inline const std::string small_asf = R"(# a comment
:version 1.10
:name SMALL
:units
  mass 1.0
  length 0.45
  angle deg
:documentation
  a rig for tests: begin with nothing
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name hip
    direction 0.6 -0.8 0
    length 2.5
    axis 0 0 0 XYZ
  end
  begin
    id 2
    name thigh
    direction 0.34202 -0.939693 0
    length 7
    axis 0 0 20 XYZ
    dof rx ry rz
    limits (-160.0 20.0)
           (-70.0 70.0)
           (-60.0 70.0)
  end
  begin
    id 3
    name shin
    direction 0.34202 -0.939693 0
    length 6.5
    axis 0 0 20 XYZ
    dof rx
    limits (-10.0 170.0)
  end
  begin
    id 4
    name foot
    direction 0.08 -0.2 0.97
    length 2
    axis -90 7.62852e-016 20 XYZ
    dof rx rz
  end
  begin
    id 5
    name spine
    direction 0 1 0
    length 4
    axis 10 -20 30 ZXY
    dof rz rx ry
  end
:hierarchy
  begin
    root hip spine
    hip thigh
    thigh shin
    shin foot
  end
)";

inline std::shared_ptr<const kinetome::Skeleton> small_skeleton() {
    return std::make_shared<const kinetome::Skeleton>(kinetome::parse_asf(small_asf, "small.asf"));
}

/// One whole frame, thigh to spine in this order.
inline std::string small_frame(int number) {
    return std::to_string(number) +
           "\n"
           "root 1.5 17.25 -2 10 -170.5 5\n"
           "thigh -20 5 1.39149e-015\n"
           "shin 40.125\n"
           "foot 7 -8\n"
           "spine 1 2 3\n";
}

inline std::string small_amc(int frames) {
    std::string text = "#!OML:ASF small.asf\n:FULLY-SPECIFIED\n:DEGREES\n";
    for (int frame = 1; frame <= frames; ++frame) text += small_frame(frame);
    return text;
}

/// A smooth motion that turns every joint through large angles.
inline kinetome::Clip small_motion(int64_t frames, double rate = 120.0) {
    kinetome::Clip clip{small_skeleton(), {}, rate, {}};
    clip.motion.resize(frames, clip.skeleton->dof_count());
    for (int64_t frame = 0; frame < frames; ++frame) {
        const double seconds = static_cast<double>(frame) / rate;
        for (int64_t dof = 0; dof < clip.motion.cols(); ++dof) {
            const double phase = seconds * (1.0 + 0.1 * static_cast<double>(dof));
            const double size = dof < 3 ? 100.0 : 1.4;
            clip.motion(frame, dof) = static_cast<float>(size * std::sin(phase));
        }
    }
    return clip;
}
