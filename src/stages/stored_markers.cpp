#include "kinetome/stages/stored_markers.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/store/feature_store.h"

namespace kinetome {
namespace {

std::vector<std::string> parts_of(const std::string& patterns) {
    std::vector<std::string> parts;
    std::istringstream text(patterns);
    for (std::string part; std::getline(text, part, ',');) parts.push_back(part);
    return parts;
}

bool matches(const std::string& name, const std::vector<std::string>& patterns) {
    return patterns.empty() || std::ranges::any_of(patterns, [&](const std::string& pattern) {
               return fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
           });
}

/// The takes of a class while they are brought together.
struct Collected {
    MarkerTakes takes;
    std::vector<MatrixF> parts;
};

MarkerTakes joined(Collected& collected) {
    MarkerTakes& takes = collected.takes;
    takes.poses.resize(takes.takes.back().end, collected.parts.front().cols());
    for (size_t i = 0; i < collected.parts.size(); ++i) {
        takes.poses.middleRows(takes.takes[i].first, takes.takes[i].size()) = collected.parts[i];
        collected.parts[i].resize(0, 0);
    }
    return std::move(takes);
}

}  // namespace

std::vector<MarkerTakes> stored_markers(const Generation& generation, const std::string& patterns) {
    const std::vector<std::string> wanted = parts_of(patterns);
    std::map<std::string, Collected> classes;
    for (const Receipt* const receipt : generation.made_by("features")) {
        const FeatureShardReader shard(generation.open(receipt->file.file_name));
        for (const FeatureShardClip& clip : shard.clips()) {
            if (clip.pose_rows == 0 || !matches(clip.name, wanted)) continue;
            Collected& collected = classes[clip.clip_class];
            MarkerTakes& takes = collected.takes;
            if (takes.names.empty()) {
                const FeatureClass shared = shard.feature_class(clip.clip_class);
                takes.clip_class = clip.clip_class;
                takes.marker_names = shared.marker_names;
                takes.rate = shared.pose_rate;
            }
            const int64_t first = takes.takes.empty() ? 0 : takes.takes.back().end;
            takes.names.push_back(clip.name);
            takes.takes.push_back({first, first + clip.pose_rows});
            collected.parts.push_back(
                shard.markers(clip.clip_class, clip.first_pose_row, clip.pose_rows));
        }
    }
    if (classes.empty()) {
        throw UsageError(fmt::format("no take is called {}; kinetome export STORE clips lists them",
                                     quote_for_message(patterns)));
    }
    std::vector<MarkerTakes> result;
    for (auto& [clip_class, collected] : classes) result.push_back(joined(collected));
    return result;
}

}  // namespace kinetome
