#include "kinetome/models/subject_partition.h"

#include <filesystem>
#include <stdexcept>

namespace kinetome {

bool partition_by_subject(PartitionRule rule, int64_t frames) {
    if (rule == PartitionRule::automatic) return frames > most_frames_together;
    return rule == PartitionRule::subject;
}

std::string subject_of(const std::string& path, const std::optional<std::regex>& pattern) {
    if (pattern) {
        if (pattern->mark_count() == 0)
            throw std::invalid_argument(
                "the pattern for subjects captures nothing; put the part of the path that names "
                "the subject in parentheses");
        std::smatch match;
        if (std::regex_search(path, match, *pattern) && match[1].matched) return match[1].str();
    }
    return std::filesystem::path(path).parent_path().generic_string();
}

}  // namespace kinetome
