#include "clip_list.h"

#include <algorithm>
#include <sstream>

namespace kinetome::cli {

std::vector<std::string> listed_clips(const std::vector<std::string>& words,
                                      const Catalog& catalog) {
    std::vector<std::string> names;
    for (const std::string& word : words) {
        if (std::ranges::binary_search(catalog.clips, word, {}, &CatalogClip::name)) {
            names.push_back(word);
            continue;
        }
        std::istringstream list(word);
        for (std::string name; std::getline(list, name, ',');) names.push_back(name);
    }
    return names;
}

}  // namespace kinetome::cli
