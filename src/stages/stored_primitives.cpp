#include <algorithm>
#include <map>
#include <memory>

#include "kinetome/stages/label_rows.h"
#include "kinetome/stages/segment_file.h"
#include "kinetome/stages/stored_clips.h"
#include "kinetome/stages/stored_graph.h"

namespace kinetome {

void label_primitives(std::vector<ClipPrimitive>& primitives, const std::vector<CycleRow>& labels) {
    std::map<std::string, std::vector<const CycleRow*>> rows_of;
    for (const CycleRow& row : labels) rows_of[row.clip].push_back(&row);
    for (ClipPrimitive& primitive : primitives) {
        const auto rows = rows_of.find(primitive.clip);
        if (rows == rows_of.end()) continue;
        std::map<std::string, int64_t> covered;
        for (const CycleRow* const row : rows->second) {
            const int64_t frames =
                std::min(row->end, primitive.end) - std::max(row->first, primitive.first);
            if (frames > 0) covered[row->label] += frames;
        }
        const auto most =
            std::ranges::max_element(covered, {}, [](const auto& one) { return one.second; });
        const int64_t length = primitive.end - primitive.first;
        if (most != covered.end() && 2 * most->second >= length) primitive.label = most->first;
    }
}

void label_from_table(std::vector<ClipPrimitive>& primitives, const OpenStore& open,
                      const std::filesystem::path& labels) {
    const Catalog& catalog = open.generation.catalog();
    const std::filesystem::path own = open.store.path() / "labels.csv";
    if (!labels.empty()) {
        label_primitives(primitives, read_label_rows(labels, catalog));
    } else if (std::filesystem::exists(own)) {  // it outlives the takes of one generation
        label_primitives(primitives, read_label_rows(own, catalog, UnknownClips::passed_over));
    }
}

std::vector<ClipPrimitive> stored_primitives(const OpenStore& open,
                                             const std::filesystem::path& labels) {
    const ArtifactReader file = open.generation.open("primitives.h5");
    const double rate = effector_rate_of(file);
    std::vector<ClipPrimitive> primitives;
    for (const PrimitiveClip& clip : read_primitives(file)) {
        for (const StoredPrimitive& stored : clip.primitives) {
            const RowRange& frames = stored.primitive.frames;
            primitives.push_back({.clip = clip.clip.name,
                                  .first = source_boundary(clip.clip, frames.first, rate),
                                  .end = source_boundary(clip.clip, frames.end, rate),
                                  .cluster = stored.cluster});
        }
    }
    label_from_table(primitives, open, labels);
    return primitives;
}

ClipSource clip_source(const Generation& generation) {
    const auto clips = std::make_shared<StoredClips>(generation);
    return {[=](const std::string& name) {
                const CatalogClip& clip = clips->find(name);
                return ClipKind{clip.clip_class, clip.rate};
            },
            [=](const std::string& name) { return clips->read(name).clip; }};
}

}  // namespace kinetome
