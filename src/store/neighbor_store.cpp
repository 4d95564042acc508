#include "kinetome/store/neighbor_store.h"

#include <functional>
#include <numeric>

#include "class_datasets.h"
#include "kinetome/base/error.h"
#include "kinetome/store/catalog.h"
#include "kinetome/store/groups.h"

namespace kinetome {

NeighborShardWriter::NeighborShardWriter(const std::filesystem::path& path,
                                         const ArtifactHeader& header, const WriteOptions& options,
                                         double effector_rate, NeighborScope scope)
    : file_(path, header, options), effector_rate_(effector_rate), scope_(scope) {}

void NeighborShardWriter::begin_class(const std::string& name) {
    file_.write<double>({.path = at(name, "effector_rate"),
                         .type = ElementType::float64,
                         .units = "frames/s",
                         .description = "rate that frames count at",
                         .sharding = Sharding::constant},
                        one(effector_rate_));
    const auto rows = [&](const char* what, ElementType type, const char* units,
                          const char* description, const char* source = "") {
        file_.create({.path = at(name, what),
                      .type = type,
                      .units = units,
                      .description = description,
                      .source = source});
    };
    rows("clips/id", ElementType::int64, "1", "clip id");
    rows("clips/name", ElementType::text, "1", "clip name");
    rows("clips/source_frames", ElementType::int64, "frames", "frames of the source");
    rows("clips/source_rate", ElementType::float64, "frames/s", "frame rate of the source");
    rows("clips/frames", ElementType::int64, "frames",
         "frames at effector_rate: rows of the clip in neighbour_count; they follow those of the "
         "clips before it");
    rows("clips/edges", ElementType::int64, "1",
         "rows of the clip in neighbour and distance; they follow those of the clips before it");
    rows("clips/radius", ElementType::float64, "cm", "r: neighbours are no farther", "S3 §3");
    rows("neighbour_count", ElementType::int32, "1",
         "neighbours of each frame; their rows follow those of the frames before it", "S3 §3");
    if (scope_ == NeighborScope::corpus) {
        rows("neighbour_clip", ElementType::int64, "1",
             "clip id of each neighbour, clips of each frame in name order");
        rows("neighbour", ElementType::int32, "frames",
             "frames of neighbour_clip, ascending in each", "S3 §3");
    } else {
        rows("neighbour", ElementType::int32, "frames",
             "frames of the same clip, ascending for each frame, itself among them", "S3 §3");
    }
    rows("distance", ElementType::float32, "cm", "between the stacked features of the two frames",
         "S3 §3");
    classes_.insert(name);
}

void NeighborShardWriter::add(const NeighborClip& clip, std::span<const int64_t> offsets,
                              std::span<const int32_t> neighbours, std::span<const float> distances,
                              std::span<const int64_t> clips) {
    if (!classes_.count(clip.clip_class)) begin_class(clip.clip_class);
    const auto path = [&](const char* what) { return at(clip.clip_class, what); };
    const int64_t id = clip_id(clip.name);
    const auto frames = static_cast<int64_t>(offsets.size()) - 1;
    const auto edges = static_cast<int64_t>(neighbours.size());
    std::vector<int32_t> counts;
    for (size_t i = 1; i < offsets.size(); ++i) {
        counts.push_back(static_cast<int32_t>(offsets[i] - offsets[i - 1]));
    }
    file_.append<int64_t>(path("clips/id"), one(id));
    file_.append_texts(path("clips/name"), one(clip.name));
    file_.append<int64_t>(path("clips/source_frames"), one(clip.source_frames));
    file_.append<double>(path("clips/source_rate"), one(clip.source_rate));
    file_.append<int64_t>(path("clips/frames"), one(frames));
    file_.append<int64_t>(path("clips/edges"), one(edges));
    file_.append<double>(path("clips/radius"), one(clip.radius));
    file_.append<int32_t>(path("neighbour_count"), counts);
    if (scope_ == NeighborScope::corpus) file_.append(path("neighbour_clip"), clips);
    file_.append(path("neighbour"), neighbours);
    file_.append(path("distance"), distances);
}

ArtifactRecord NeighborShardWriter::close() {
    return file_.close();
}

NeighborShardReader::NeighborShardReader(ArtifactReader file) : file_(std::move(file)) {
    for (const std::string& group : groups_with(file_, "/clips/name")) {
        const std::string name = group.substr(1);
        const auto names = file_.read_texts(at(name, "clips/name"));
        const auto source_frames = file_.read<int64_t>(at(name, "clips/source_frames"));
        const auto source_rate = file_.read<double>(at(name, "clips/source_rate"));
        const auto radius = file_.read<double>(at(name, "clips/radius"));
        const auto frames = file_.read<int64_t>(at(name, "clips/frames"));
        const auto edges = file_.read<int64_t>(at(name, "clips/edges"));
        int64_t frame = 0, edge = 0;
        for (size_t i = 0; i < names.size(); ++i) {
            clips_.push_back({{names[i], name, source_frames[i], source_rate[i], radius[i]},
                              frame,
                              frames[i],
                              edge,
                              edges[i]});
            frame += frames[i];
            edge += edges[i];
        }
    }
}

StoredNeighbors NeighborShardReader::read(size_t i) const {
    const NeighborShardClip& place = clips_.at(i);
    const auto path = [&](const char* what) { return at(place.clip.clip_class, what); };
    const auto counts =
        file_.read<int32_t>(path("neighbour_count"), place.first_frame, place.frames);
    StoredNeighbors stored;
    stored.offsets.assign(counts.size() + 1, 0);
    std::inclusive_scan(counts.begin(), counts.end(), stored.offsets.begin() + 1, std::plus<>(),
                        int64_t{0});
    if (stored.offsets.back() != place.edges) {
        throw StoreError(file_.path().string() + ": " + path("neighbour_count") +
                         " does not add up to the edges of " + place.clip.name);
    }
    stored.neighbours = file_.read<int32_t>(path("neighbour"), place.first_edge, place.edges);
    stored.distances = file_.read<float>(path("distance"), place.first_edge, place.edges);
    if (file_.contains(path("neighbour_clip"))) {
        stored.clips = file_.read<int64_t>(path("neighbour_clip"), place.first_edge, place.edges);
    }
    return stored;
}

double NeighborShardReader::effector_rate(const std::string& clip_class) const {
    return file_.read<double>(at(clip_class, "effector_rate")).at(0);
}

}  // namespace kinetome
