// What changed between two generations.
#pragma once

#include <string>
#include <vector>

#include "kinetome/run/generation.h"

namespace kinetome {

struct GenerationDifference {
    std::vector<std::string> added;     ///< clips indexed in the second alone
    std::vector<std::string> removed;   ///< clips indexed in the first alone
    std::vector<std::string> changed;   ///< clips of another content
    std::vector<std::string> options;   ///< "clusters: 0 → 250"
    std::vector<std::string> files;     ///< artifacts made again, added or gone, with the reason
    std::vector<std::string> datasets;  ///< "pose_clusters /…/means": logical content differs

    bool empty() const;
};

GenerationDifference compare_generations(const Generation& first, const Generation& second);

}  // namespace kinetome
