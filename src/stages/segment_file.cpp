#include "kinetome/stages/segment_file.h"

#include <cmath>
#include <map>

#include "kinetome/formats/resample.h"
#include "kinetome/store/catalog.h"

namespace kinetome {
namespace {

DatasetSpec spec(const char* path, ElementType type, const char* units, const char* description,
                 const char* source = "") {
    return {std::string("/") + path, type, {}, units, description, source, "", {}};
}

/// What a file tells of its clips.
void write_clips(ArtifactWriter& file, const std::vector<CutClip>& clips, double rate) {
    file.write<double>(
        spec("effector_rate", ElementType::float64, "frames/s", "rate that frames count at"),
        std::span(&rate, 1));
    write_cut_clips(file, clips, "effector rate");
}

void move_to_source(RowRange& frames, const CutClip& clip, double effector_rate) {
    frames = {source_boundary(clip, frames.first, effector_rate),
              source_boundary(clip, frames.end, effector_rate)};
}

/// Where rows with a clip id go.
template <class Clip>
std::map<int64_t, Clip*> by_id(std::vector<Clip>& clips) {
    std::map<int64_t, Clip*> found;
    for (Clip& clip : clips) found[clip_id(clip.clip.name)] = &clip;
    return found;
}

}  // namespace

void write_cut_clips(ArtifactWriter& file, const std::vector<CutClip>& clips, const char* rate) {
    std::vector<int64_t> ids, frames, source_frames;
    std::vector<std::string> names, classes;
    std::vector<double> source_rates;
    for (const CutClip& clip : clips) {
        ids.push_back(clip_id(clip.name));
        names.push_back(clip.name);
        classes.push_back(clip.clip_class);
        frames.push_back(clip.frames);
        source_frames.push_back(clip.source_frames);
        source_rates.push_back(clip.source_rate);
    }
    const std::string frames_at = std::string("frames at the ") + rate;
    file.write<int64_t>(spec("clips/id", ElementType::int64, "1", "clip id"), ids);
    file.write_texts(spec("clips/name", ElementType::text, "1", "clip name"), names);
    file.write_texts(spec("clips/class", ElementType::text, "1", "class of skeletons"), classes);
    file.write<int64_t>(spec("clips/frames", ElementType::int64, "frames", frames_at.c_str()),
                        frames);
    file.write<int64_t>(
        spec("clips/source_frames", ElementType::int64, "frames", "frames of the source"),
        source_frames);
    file.write<double>(
        spec("clips/source_rate", ElementType::float64, "frames/s", "frame rate of the source"),
        source_rates);
}

std::vector<CutClip> read_cut_clips(const ArtifactReader& file) {
    const auto names = file.read_texts("/clips/name"), classes = file.read_texts("/clips/class");
    const auto frames = file.read<int64_t>("/clips/frames");
    const auto source_frames = file.read<int64_t>("/clips/source_frames");
    const auto source_rates = file.read<double>("/clips/source_rate");
    std::vector<CutClip> clips;
    for (size_t i = 0; i < names.size(); ++i) {
        clips.push_back({names[i], classes[i], frames[i], source_frames[i], source_rates[i]});
    }
    return clips;
}

void write_segments(ArtifactWriter& file, const std::vector<SegmentedClip>& clips, double rate) {
    std::vector<CutClip> cut;
    std::vector<int64_t> ids;
    std::vector<int32_t> firsts, ends, kinds, clusters;
    for (const SegmentedClip& clip : clips) {
        cut.push_back(clip.clip);
        for (const Segment& segment : clip.segments) {
            ids.push_back(clip_id(clip.clip.name));
            firsts.push_back(static_cast<int32_t>(segment.frames.first));
            ends.push_back(static_cast<int32_t>(segment.frames.end));
            kinds.push_back(segment.kind == SegmentKind::transition ? 1 : 0);
            clusters.push_back(segment.cluster);
        }
    }
    write_clips(file, cut, rate);
    file.write<int64_t>(spec("segments/clip", ElementType::int64, "1", "clip id", "S3 §3.1"), ids);
    file.write<int32_t>(spec("segments/first_frame", ElementType::int32, "frames",
                             "first frame in its clip, at the effector rate", "S3 §3.1"),
                        firsts);
    file.write<int32_t>(
        spec("segments/end_frame", ElementType::int32, "frames", "end, exclusive", "S3 §3.1"),
        ends);
    file.write<int32_t>(
        spec("segments/kind", ElementType::int32, "1", "0: activity, 1: transition", "S3 §3.1"),
        kinds);
    file.write<int32_t>(spec("segments/activity_cluster", ElementType::int32, "1",
                             "activities of a clip that are the same; -1: transition", "S3 §4"),
                        clusters);
}

std::vector<SegmentedClip> read_segments(const ArtifactReader& file) {
    std::vector<SegmentedClip> clips;
    for (CutClip& clip : read_cut_clips(file)) clips.push_back({std::move(clip), {}});
    const auto place = by_id(clips);
    const auto ids = file.read<int64_t>("/segments/clip");
    const auto firsts = file.read<int32_t>("/segments/first_frame");
    const auto ends = file.read<int32_t>("/segments/end_frame");
    const auto kinds = file.read<int32_t>("/segments/kind");
    const auto clusters = file.read<int32_t>("/segments/activity_cluster");
    for (size_t i = 0; i < ids.size(); ++i) {
        place.at(ids[i])->segments.push_back(
            {{firsts[i], ends[i]},
             kinds[i] == 1 ? SegmentKind::transition : SegmentKind::activity,
             clusters[i]});
    }
    return clips;
}

void write_primitives(ArtifactWriter& file, const std::vector<PrimitiveClip>& clips, double rate) {
    std::vector<CutClip> cut;
    std::vector<int64_t> ids;
    std::vector<int32_t> firsts, ends, activities, take_clusters, clusters;
    for (const PrimitiveClip& clip : clips) {
        cut.push_back(clip.clip);
        for (const StoredPrimitive& stored : clip.primitives) {
            ids.push_back(clip_id(clip.clip.name));
            firsts.push_back(static_cast<int32_t>(stored.primitive.frames.first));
            ends.push_back(static_cast<int32_t>(stored.primitive.frames.end));
            activities.push_back(stored.primitive.activity);
            take_clusters.push_back(stored.take_cluster);
            clusters.push_back(stored.cluster);
        }
    }
    write_clips(file, cut, rate);
    file.write<int64_t>(spec("primitives/clip", ElementType::int64, "1", "clip id", "S3 §3.2"),
                        ids);
    file.write<int32_t>(spec("primitives/first_frame", ElementType::int32, "frames",
                             "first frame in its clip, at the effector rate", "S3 §3.2"),
                        firsts);
    file.write<int32_t>(
        spec("primitives/end_frame", ElementType::int32, "frames", "end, exclusive", "S3 §3.2"),
        ends);
    file.write<int32_t>(spec("primitives/activity", ElementType::int32, "1",
                             "segment of its clip that it lies in, from 0", "S3 §3.2"),
                        activities);
    file.write<int32_t>(spec("primitives/take_cluster", ElementType::int32, "1",
                             "cluster among the primitives of its clip", "S3 §4"),
                        take_clusters);
    file.write<int32_t>(spec("primitives/cluster", ElementType::int32, "1",
                             "cluster among the primitives of the corpus", "S3 §4"),
                        clusters);
}

std::vector<PrimitiveClip> read_primitives(const ArtifactReader& file) {
    std::vector<PrimitiveClip> clips;
    for (CutClip& clip : read_cut_clips(file)) clips.push_back({std::move(clip), {}});
    const auto place = by_id(clips);
    const auto ids = file.read<int64_t>("/primitives/clip");
    const auto firsts = file.read<int32_t>("/primitives/first_frame");
    const auto ends = file.read<int32_t>("/primitives/end_frame");
    const auto activities = file.read<int32_t>("/primitives/activity");
    const auto take_clusters = file.read<int32_t>("/primitives/take_cluster");
    const auto clusters = file.read<int32_t>("/primitives/cluster");
    for (size_t i = 0; i < ids.size(); ++i) {
        place.at(ids[i])->primitives.push_back(
            {{{firsts[i], ends[i]}, activities[i]}, take_clusters[i], clusters[i]});
    }
    return clips;
}

double effector_rate_of(const ArtifactReader& file) {
    return file.read<double>("/effector_rate").at(0);
}

int64_t source_boundary(const CutClip& clip, int64_t frame, double rate) {
    if (frame >= clip.frames) return clip.source_frames;
    return static_cast<int64_t>(std::ceil(source_frame(frame, clip.source_rate, rate)));
}

std::vector<SegmentedClip> in_source(std::vector<SegmentedClip> clips, double effector_rate) {
    for (SegmentedClip& clip : clips) {
        for (Segment& segment : clip.segments)
            move_to_source(segment.frames, clip.clip, effector_rate);
        std::erase_if(clip.segments, [](const Segment& one) { return one.frames.size() == 0; });
    }
    return clips;
}

std::vector<PrimitiveClip> in_source(std::vector<PrimitiveClip> clips, double effector_rate) {
    for (PrimitiveClip& clip : clips) {
        for (StoredPrimitive& stored : clip.primitives) {
            move_to_source(stored.primitive.frames, clip.clip, effector_rate);
        }
        std::erase_if(clip.primitives,
                      [](const StoredPrimitive& one) { return one.primitive.frames.size() == 0; });
    }
    return clips;
}

}  // namespace kinetome
