#include "kinetome/store/groups.h"

namespace kinetome {

std::vector<std::string> groups_with(const ArtifactReader& file, std::string_view dataset) {
    std::vector<std::string> groups;
    for (const DatasetSpec& spec : file.datasets()) {
        if (spec.path.ends_with(dataset))
            groups.push_back(spec.path.substr(0, spec.path.size() - dataset.size()));
    }
    return groups;
}

}  // namespace kinetome
