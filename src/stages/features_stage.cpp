// features: pose vectors, effector features and marker sets of each clip, shard by shard.
#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <memory>

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
using Token = std::shared_ptr<Passenger>;

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

/// Clips that may be in the pipeline at once: two a thread, fewer when the largest ones would not
/// fit in a quarter of the memory granted.
size_t clips_in_flight(const StageContext& context, const FrameShardReader& frames) {
    constexpr uint64_t bytes_per_frame = 4 * 1024;  // a frame, its positions and features, twice
    uint64_t largest = 1;
    for (const FrameShardClip& clip : frames.clips()) {
        largest = std::max(largest, static_cast<uint64_t>(clip.frames));
    }
    return std::clamp<uint64_t>(context.resources.memory_bytes / 4 / (largest * bytes_per_frame), 1,
                                2 * static_cast<uint64_t>(context.resources.threads));
}

}  // namespace

StageResult make_features(const StageContext& context, const StageTask& task) {
    const FrameShardReader frames(context.workspace.open(*task.inputs_of("frames").front()));
    FeatureShardWriter writer(task.output, task.header,
                              parse_compression(context.options.frames.compression));
    int64_t total = 0;
    for (const FrameShardClip& clip : frames.clips()) total += clip.frames;
    Progress progress(context.log, "features " + task.shard->cut, total, "frames");
    StageResult result;

    size_t next = 0;
    const auto read = [&](tbb::flow_control& control) -> Token {
        if (next == frames.clips().size() || context.stop.requested()) {
            control.stop();
            return nullptr;
        }
        return std::make_shared<Passenger>(Passenger{frames.read(next++), {}});
    };
    const auto work = [&](Token passenger) {
        compute(context.options.features, *passenger);
        return passenger;
    };
    const auto write = [&](const Token& passenger) {
        const ClipFeatures& features = passenger->features;
        if (!writer.has_class(features.clip_class)) {
            writer.begin_class(
                features.clip_class,
                feature_class_of(*passenger->stored.clip.skeleton, context.options.features));
        }
        writer.add(features);
        if (features.source_rate < context.options.features.pose_rate) {
            result.clips.push_back({.clip = features.name,
                                    .warnings = {"source rate is below the analysis rate: "
                                                 "frames are interpolated"}});
        }
        progress.advance(features.source_frames);
    };
    tbb::parallel_pipeline(
        clips_in_flight(context, frames),
        tbb::make_filter<void, Token>(tbb::filter_mode::serial_in_order, read) &
            tbb::make_filter<Token, Token>(tbb::filter_mode::parallel, work) &
            tbb::make_filter<Token, void>(tbb::filter_mode::serial_in_order, write));
    context.stop.check();
    result.file = writer.close();
    return result;
}

}  // namespace kinetome
