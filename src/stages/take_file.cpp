#include "kinetome/stages/take_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"
#include "kinetome/formats/asf_amc.h"
#include "kinetome/formats/joint_roles.h"
#include "kinetome/formats/take_format.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

fs::path skeleton_beside(const fs::path& take, std::string_view extension) {
    const std::string stem = take.stem().string();
    const fs::path folder = take.has_parent_path() ? take.parent_path() : fs::path(".");
    for (const std::string& name : {stem.substr(0, stem.find('_')), stem}) {
        const fs::path file = folder / (name + std::string(extension));
        if (fs::is_regular_file(file)) return file;
    }
    std::vector<fs::path> all;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() == extension) all.push_back(entry.path());
    }
    if (all.size() == 1) return all.front();
    throw InputError::in_file(
        path_for_message(take.string()),
        fmt::format("no skeleton: looked for {0}{2}, {1}{2} and a single {2} file in its folder "
                    "({3} there)",
                    stem.substr(0, stem.find('_')), stem, extension, all.size()));
}

std::vector<std::string> known_extensions() {
    std::vector<std::string> extensions;
    for (const TakeFormat& format : take_formats()) extensions.emplace_back(format.extension);
    return extensions;
}

}  // namespace

Clip read_take_file(const fs::path& path, const TakeFileOptions& options) {
    const std::string name = path_for_message(path.string());
    const TakeFormat* const format = find_take_format(path.extension().string());
    if (!format) {
        throw UsageError(fmt::format("{}: not the name of a take; what can be read: {}", name,
                                     fmt::join(known_extensions(), ", ")));
    }
    std::optional<JointMap> joint_map;
    if (!options.joint_map.empty()) joint_map = load_joint_map(options.joint_map.string());
    const auto with_roles = [&](Skeleton skeleton, const std::string& origin) {
        assign_roles(skeleton, origin, joint_map ? &*joint_map : nullptr);
        return std::make_shared<const Skeleton>(std::move(skeleton));
    };

    const std::string bytes = read_source_file(path);
    TakeSource source{
        .bytes = bytes, .path = name, .skeleton = nullptr, .default_rate = options.rate};
    if (!format->skeleton_extension.empty()) {
        const fs::path file = skeleton_beside(path, format->skeleton_extension);
        const std::string origin = path_for_message(file.string());
        source.skeleton = with_roles(parse_asf(read_source_file(file), origin), origin);
    }
    Clip clip = format->parse(source);
    if (!source.skeleton) clip.skeleton = with_roles(*clip.skeleton, name);
    return clip;
}

}  // namespace kinetome
