// Which end effectors are compared, as the option `joints` names them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// "all", "arms", "left-arm", …
std::vector<std::string> joint_words();

/// Of words separated by commas, in the order of effector_roles; nothing for any other text.
std::optional<std::vector<JointRole>> parse_joints(std::string_view text);

/// The fewest words that parse_joints reads back.
std::string write_joints(const std::vector<JointRole>& joints);

}  // namespace kinetome
