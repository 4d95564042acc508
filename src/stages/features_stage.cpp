// features: pose vectors, effector features and marker sets of each clip, shard by shard.
#include <algorithm>
#include <memory>

#include "clip_pipeline.h"
#include "kinetome/base/progress.h"
#include "kinetome/features/effectors.h"
#include "kinetome/features/markers.h"
#include "kinetome/features/pose_vector.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/resample.h"
#include "kinetome/stages/stage.h"
#include "kinetome/store/feature_store.h"
#include "kinetome/store/frame_store.h"

namespace kinetome {
namespace {

struct Passenger {
    StoredClip stored;
    ClipFeatures features;
};

FeatureClass feature_class_of(const Skeleton& skeleton, const FeatureOptions& options) {
    FeatureClass shared;
    for (const PoseVectorColumn& column : pose_vector_columns(skeleton)) {
        shared.pose_vector_names.push_back(column.name);
        shared.pose_vector_units.push_back(column.unit);
        shared.pose_vector_floors.push_back(column.floor);
    }
    shared.marker_names = marker_names(skeleton);
    shared.pose_rate = options.pose_rate;
    shared.effector_rate = options.effector_rate;
    return shared;
}

/// The clip at another rate, positions included; the stored ones serve when the rate is the same.
StoredClip at_rate(const StoredClip& stored, double rate) {
    StoredClip result{stored.name, resample(stored.clip, rate), {}};
    result.positions = stored.clip.rate == rate ? stored.positions : joint_positions(result.clip);
    return result;
}

void compute(const FeatureOptions& options, Passenger& passenger) {
    const StoredClip& stored = passenger.stored;
    const Skeleton& skeleton = *stored.clip.skeleton;
    ClipFeatures& features = passenger.features;
    features.name = stored.name;
    features.clip_class = skeleton.class_name();
    features.source_frames = stored.clip.frames();
    features.source_rate = stored.clip.rate;

    const StoredClip pose = at_rate(stored, options.pose_rate);
    features.pose_vectors =
        pose_vectors(skeleton, pose.clip.motion, options.pose_rate, options.velocity_reach);
    features.markers = normalised_markers(skeleton, pose.clip.motion, pose.positions);
    const StoredClip graph = at_rate(stored, options.effector_rate);
    features.effectors = effector_positions(skeleton, graph.clip.motion, graph.positions);
}

/// Memory that the largest clip of a shard needs on its way.
uint64_t largest_clip(const FrameShardReader& frames) {
    constexpr uint64_t bytes_per_frame = 4 * 1024;  // a frame, its positions and features, twice
    int64_t largest = 0;
    for (const FrameShardClip& clip : frames.clips()) largest = std::max(largest, clip.frames);
    return static_cast<uint64_t>(largest) * bytes_per_frame;
}

}  // namespace

StageResult make_features(const StageContext& context, const StageTask& task) {
    const FrameShardReader frames(context.workspace.open(*task.inputs_of("frames").front()));
    FeatureShardWriter writer(task.output, task.header, context.writing());
    int64_t total = 0;
    for (const FrameShardClip& clip : frames.clips()) total += clip.frames;
    Progress progress(context.log, "features " + task.shard->cut, total, "frames");
    StageResult result;

    size_t next = 0;
    const auto read = [&]() -> std::shared_ptr<Passenger> {
        if (next == frames.clips().size()) return nullptr;
        return std::make_shared<Passenger>(Passenger{frames.read(next++), {}});
    };
    const auto work = [&](Passenger& passenger) { compute(context.options.features, passenger); };
    const auto write = [&](const Passenger& passenger) {
        const ClipFeatures& features = passenger.features;
        if (!writer.has_class(features.clip_class)) {
            writer.begin_class(
                features.clip_class,
                feature_class_of(*passenger.stored.clip.skeleton, context.options.features));
        }
        writer.add(features);
        if (features.source_rate < context.options.features.pose_rate) {
            result.clips.push_back({.clip = features.name,
                                    .warnings = {"source rate is below the analysis rate: "
                                                 "frames are interpolated"}});
        }
        progress.advance(features.source_frames);
    };
    run_clip_pipeline<Passenger>(clips_in_flight(context.resources, largest_clip(frames)),
                                 context.stop, read, work, write);
    result.file = writer.close();
    return result;
}

}  // namespace kinetome
