#include "kinetome/stages/stored_timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "kinetome/stages/segment_file.h"

namespace kinetome {

Timeline stored_timeline(const Generation& generation) {
    std::map<std::string, std::vector<RowRange>> primitives;
    for (const PrimitiveClip& clip : read_primitives(generation.open("primitives.h5"))) {
        for (const StoredPrimitive& stored : clip.primitives) {
            primitives[clip.clip.name].push_back(stored.primitive.frames);
        }
    }
    const ArtifactReader file = generation.open("segments.h5");
    const std::vector<SegmentedClip> clips = read_segments(file);
    Timeline timeline;
    timeline.title = fmt::format("Activities and primitives of {} takes", clips.size());
    timeline.rate = effector_rate_of(file);
    for (const SegmentedClip& clip : clips) {
        timeline.frames = std::max(timeline.frames, clip.clip.frames);
        timeline.rows.push_back(
            segment_row(clip.clip.name, clip.segments, primitives[clip.clip.name]));
    }
    return timeline;
}

}  // namespace kinetome
