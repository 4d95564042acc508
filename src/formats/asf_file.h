// An ASF file as it stands: its sections in the file's own units, before they become a skeleton.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// A bone, or the root, which has a position in place of direction and length.
struct AsfBone {
    std::string name;
    int64_t line = 0;  ///< where it begins, for messages
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    std::optional<Eigen::Vector3d> direction;
    std::optional<double> length;
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    std::array<int, 3> axis_order = {0, 1, 2};  ///< the one that acts first in front
    std::vector<Channel> channels;
    std::vector<std::pair<double, double>> limits;  ///< one a channel, or none
};

/// One child of one line of :hierarchy.
struct AsfAttachment {
    std::string parent;
    std::string child;
    int64_t line = 0;
};

struct AsfFile {
    std::string name;
    double length = 0;                        ///< the length unit as stated, positive
    double angle = std::numbers::pi / 180.0;  ///< radians of one unit of angle
    std::vector<AsfBone> bones;               ///< the root first, then in the file's order
    std::vector<AsfAttachment> attachments;
};

/// Reads the text; every section there, every bone complete, names once. Whether the hierarchy
/// makes sense is not looked at. Throws InputError.
AsfFile read_asf_file(std::string_view text, const std::string& path);

}  // namespace kinetome
