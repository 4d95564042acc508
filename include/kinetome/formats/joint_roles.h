// Which joint of a rig is the head, a wrist, an ankle: by known naming schemes or by a user's map.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// A user's own choice of joints by role (`--joint-map`); roles that it leaves out are looked up in
/// the known schemes.
using JointMap = std::map<JointRole, std::string>;

/// Reads a TOML file of lines such as `left_ankle = "LeftFoot"`; the keys are joint_role_name's.
/// Throws UsageError.
JointMap load_joint_map(const std::filesystem::path& path);

/// Gives the skeleton's joints their roles: those of `map` first, the rest from the known scheme
/// that names most of them. Throws InputError, listing the joints found and the roles missing, when
/// root, head, wrists, ankles and hips are not all known, or when the map names a joint the
/// skeleton does not have. `path` is for the message only.
void assign_roles(Skeleton& skeleton, const std::string& path, const JointMap* map = nullptr);

}  // namespace kinetome
