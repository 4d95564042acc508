#include "kinetome/stages/motion_string_file.h"

#include <map>

#include "kinetome/store/catalog.h"
#include "kinetome/store/groups.h"

namespace kinetome {

std::vector<std::string> spelled_partitions(const ArtifactReader& file) {
    return groups_with(file, "/letters/letter");
}

StoredMotionString read_motion_string(const ArtifactReader& file, const std::string& partition) {
    StoredMotionString stored;
    const auto names = file.read_texts(partition + "/clips/name");
    const auto frames = file.read<int64_t>(partition + "/clips/frames");
    const auto source_frames = file.read<int64_t>(partition + "/clips/source_frames");
    const auto rates = file.read<double>(partition + "/clips/source_rate");
    std::map<int64_t, int32_t> number_of;  // by clip id
    for (size_t i = 0; i < names.size(); ++i) {
        number_of[clip_id(names[i])] = static_cast<int32_t>(i);
        stored.clips.push_back({names[i], frames[i], source_frames[i], rates[i]});
    }
    stored.string.letters = file.read<int32_t>(partition + "/letters/letter");
    for (const int64_t id : file.read<int64_t>(partition + "/letters/clip")) {
        stored.string.clip.push_back(number_of.at(id));
    }
    stored.string.first_frame = file.read<int32_t>(partition + "/letters/first_frame");
    stored.string.end_frame = file.read<int32_t>(partition + "/letters/end_frame");
    const std::string matrix = partition + "/accessibility";
    stored.accessibility = AccessibilityMatrix(file.rows(matrix), file.read<uint64_t>(matrix));
    stored.tau = file.read<double>(partition + "/tau").at(0);
    stored.lambda = file.read<int64_t>(partition + "/lambda").at(0);
    stored.pose_rate = file.read<double>(partition + "/pose_rate").at(0);
    return stored;
}

}  // namespace kinetome
