#include "kinetome/formats/joint_roles.h"

#include <toml++/toml.h>

#include <array>
#include <optional>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"

namespace kinetome {
namespace {

/// In the order of JointRole.
constexpr std::array<std::string_view, joint_role_count> role_names = {
    "root",           "left_hip",   "right_hip",   "left_knee",  "right_knee",  "left_ankle",
    "right_ankle",    "left_toes",  "right_toes",  "lower_neck", "head",        "left_shoulder",
    "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist",
};

/// Joint names of a rig, in the order of JointRole; empty where the rig has none.
struct NamingScheme {
    std::string_view name;
    std::array<std::string_view, joint_role_count> joints;
};

/// A known rig is a row.
constexpr std::array naming_schemes = {
    // A role is the far end of its bone: the hip is where the hip joint's bone ends.
    NamingScheme{"ASF of CMU and HDM05",
                 {"root", "lhipjoint", "rhipjoint", "lfemur", "rfemur", "ltibia", "rtibia", "ltoes",
                  "rtoes", "lowerneck", "head", "lclavicle", "rclavicle", "lhumerus", "rhumerus",
                  "lwrist", "rwrist"}},
};

/// What the features cannot do without (S3 §3).
// Effector features need head, wrists and ankles (S3 §3), marker sets the hips (S2 §3).
constexpr std::array needed_roles = {
    JointRole::root,       JointRole::head,        JointRole::left_wrist, JointRole::right_wrist,
    JointRole::left_ankle, JointRole::right_ankle, JointRole::left_hip,   JointRole::right_hip};

std::optional<JointRole> find_role(std::string_view name) {
    for (size_t i = 0; i < role_names.size(); ++i) {
        if (role_names[i] == name) return static_cast<JointRole>(i);
    }
    return std::nullopt;
}

int joints_named_by(const NamingScheme& scheme, const Skeleton& skeleton) {
    int count = 0;
    for (const std::string_view joint : scheme.joints) count += skeleton.find(joint).has_value();
    return count;
}

const NamingScheme& best_scheme(const Skeleton& skeleton) {
    const NamingScheme* best = &naming_schemes.front();
    for (const NamingScheme& scheme : naming_schemes) {
        if (joints_named_by(scheme, skeleton) > joints_named_by(*best, skeleton)) best = &scheme;
    }
    return *best;
}

void assign_from_map(Skeleton& skeleton, const std::string& path, const JointMap& map) {
    for (const auto& [role, joint_name] : map) {
        const std::optional<int> joint = skeleton.find(joint_name);
        if (!joint) {
            throw InputError::in_file(path, "expected the joint " + quote_for_message(joint_name) +
                                                " that the joint map gives the role " +
                                                std::string(joint_role_name(role)) +
                                                ", found no such joint");
        }
        skeleton.set_role(role, *joint);
    }
}

std::string list_of_joints(const Skeleton& skeleton) {
    constexpr size_t most_listed = 64;
    std::string list;
    for (size_t i = 0; i < skeleton.joints().size() && i < most_listed; ++i) {
        list += (i == 0 ? "" : ", ") + quote_for_message(skeleton.joints()[i].name);
    }
    return skeleton.joints().size() > most_listed ? list + ", ..." : list;
}

void check_needed_roles(const Skeleton& skeleton, const std::string& path) {
    std::string missing;
    for (const JointRole role : needed_roles) {
        if (skeleton.role(role) >= 0) continue;
        missing += (missing.empty() ? "" : ", ") + std::string(joint_role_name(role));
    }
    if (missing.empty()) return;
    throw InputError::in_file(path, "unknown joint naming scheme: roles missing: " + missing +
                                        "; joints found: " + list_of_joints(skeleton) +
                                        "; name them with --joint-map");
}

}  // namespace

std::string_view joint_role_name(JointRole role) {
    return role_names[static_cast<size_t>(role)];
}

JointMap load_joint_map(const std::filesystem::path& path) {
    toml::table table;
    try {
        table = toml::parse_file(path.string());
    } catch (const toml::parse_error& error) {
        throw UsageError(path.string() +
                         ": expected a joint map such as left_ankle = \"LeftFoot\": " +
                         std::string(error.description()));
    }
    JointMap map;
    for (const auto& [key, value] : table) {
        const std::optional<JointRole> role = find_role(key.str());
        if (!role) {
            throw UsageError(path.string() + ": expected a joint role, found " +
                             quote_for_message(key.str()));
        }
        const std::optional<std::string> joint = value.value<std::string>();
        if (!joint) {
            throw UsageError(path.string() + ": expected the name of a joint for the role " +
                             std::string(key.str()));
        }
        map.emplace(*role, *joint);
    }
    return map;
}

void assign_roles(Skeleton& skeleton, const std::string& path, const JointMap* map) {
    if (map != nullptr) assign_from_map(skeleton, path, *map);
    const NamingScheme& scheme = best_scheme(skeleton);
    for (size_t i = 0; i < scheme.joints.size(); ++i) {
        const auto role = static_cast<JointRole>(i);
        if (skeleton.role(role) >= 0) continue;
        skeleton.set_role(role, skeleton.find(scheme.joints[i]).value_or(-1));
    }
    check_needed_roles(skeleton, path);
}

}  // namespace kinetome
