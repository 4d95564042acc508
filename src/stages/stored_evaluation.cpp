#include "kinetome/stages/stored_evaluation.h"

#include <algorithm>
#include <set>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/features/effectors.h"
#include "kinetome/features/joint_quaternions.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/resample.h"
#include "kinetome/models/ppca_segmentation.h"
#include "kinetome/stages/segment_file.h"
#include "kinetome/stages/stored_clips.h"
#include "kinetome/store/feature_store.h"

namespace kinetome {
namespace {

/// Calls take(place, effectors, effector rate) for each clip that has effectors, shard by shard.
template <class Take>
void for_each_effectors(const Generation& generation, const Take& take) {
    for (const Receipt* const receipt : generation.made_by("features")) {
        const FeatureShardReader shard(generation.open(receipt->file.file_name));
        for (const FeatureShardClip& clip : shard.clips()) {
            if (clip.effector_rows == 0) continue;
            take(clip,
                 shard.effectors(clip.clip_class, clip.first_effector_row, clip.effector_rows),
                 shard.feature_class(clip.clip_class).effector_rate);
        }
    }
}

void append_rows(MatrixF& matrix, const MatrixF& rows) {
    const Eigen::Index first = matrix.rows();
    matrix.conservativeResize(first + rows.rows(), rows.cols());
    matrix.bottomRows(rows.rows()) = rows;
}

/// The primitives of one class of skeletons, their frames one take below the other.
struct ClassRows {
    MatrixF features, point_clouds;
    std::vector<RowRange> primitives;
    std::vector<int32_t> clusters;

    void add(const PrimitiveClip& clip, const MatrixF& effectors, const MatrixF& positions) {
        const int64_t first = features.rows();
        append_rows(features, stack_neighbours(effectors));
        append_rows(point_clouds, stack_neighbours(positions));
        for (const StoredPrimitive& stored : clip.primitives) {
            const RowRange& frames = stored.primitive.frames;
            primitives.push_back({first + frames.first, first + frames.end});
            clusters.push_back(stored.cluster);
        }
    }
};

}  // namespace

std::vector<SegmentedTake> stored_segments(const Generation& generation) {
    const ArtifactReader file = generation.open("segments.h5");
    std::vector<SegmentedTake> takes;
    for (SegmentedClip& clip : in_source(read_segments(file), effector_rate_of(file))) {
        takes.push_back({clip.clip.name, clip.clip.source_frames, clip.clip.source_rate,
                         std::move(clip.segments)});
    }
    return takes;
}

std::vector<PrimitivesOfTake> stored_primitives(const Generation& generation) {
    const ArtifactReader file = generation.open("primitives.h5");
    std::vector<PrimitivesOfTake> takes;
    for (const PrimitiveClip& clip : in_source(read_primitives(file), effector_rate_of(file))) {
        PrimitivesOfTake take{clip.clip.name, {}, {}};
        for (const StoredPrimitive& stored : clip.primitives) {
            take.primitives.push_back(stored.primitive.frames);
            take.clusters.push_back(stored.cluster);
        }
        takes.push_back(std::move(take));
    }
    return takes;
}

void hold_to_store(std::vector<SegmentedTake>& takes, const Generation& generation,
                   const std::string& path) {
    const StoredClips clips(generation);
    for (SegmentedTake& take : takes) {
        const CatalogClip& clip = clips.find(take.clip);
        if (take.frames != clip.frames) {
            throw InputError::in_file(path, "the segments of clip " + quote_for_message(take.clip) +
                                                " end at frame " + std::to_string(take.frames) +
                                                ", but it has " + std::to_string(clip.frames) +
                                                " frames");
        }
        take.rate = clip.rate;
    }
}

std::map<std::string, std::vector<Segment>> segments_by_ppca(std::span<const AnnotatedTake> takes,
                                                             const Generation& generation) {
    StoredClips clips(generation);
    std::map<std::string, std::vector<Segment>> segments;
    for (const AnnotatedTake& take : takes) {
        const Clip clip = clips.read(take.take.clip).clip;
        PpcaSegmentationOptions options;
        options.rate = clip.rate;
        segments[take.take.clip] =
            ppca_segments(joint_quaternions(*clip.skeleton, clip.motion), options);
    }
    return segments;
}

PoseRecurrence stored_recurrence(const Generation& generation) {
    PoseRecurrence sum;
    for_each_effectors(generation,
                       [&](const FeatureShardClip&, const MatrixF& effectors, double rate) {
                           PoseRecurrenceOptions options;
                           options.rate = rate;
                           sum += pose_recurrence(stack_neighbours(effectors), options);
                       });
    return sum;
}

Table recurrence_table(const PoseRecurrence& recurrence) {
    const auto share = [](int64_t part, int64_t whole) {
        return whole > 0 ? double(part) / double(whole) : 0.0;
    };
    return {
        {"of takes longer than 8 s", "number", "with poses that come back within 10 s", "share"},
        {{"takes", recurrence.takes, recurrence.recurring_takes,
          share(recurrence.recurring_takes, recurrence.takes)},
         {"frames", recurrence.frames, recurrence.recurring_frames,
          share(recurrence.recurring_frames, recurrence.frames)}}};
}

std::vector<ClassVariances> stored_cluster_variances(const Generation& generation,
                                                     std::span<const std::string> clips) {
    const std::set<std::string> asked(clips.begin(), clips.end());
    std::map<std::string, PrimitiveClip> primitives;
    for (PrimitiveClip& clip : read_primitives(generation.open("primitives.h5"))) {
        if (asked.count(clip.clip.name)) primitives[clip.clip.name] = std::move(clip);
    }
    StoredClips stored(generation);
    std::map<std::string, ClassRows> rows_of_class;
    for_each_effectors(
        generation, [&](const FeatureShardClip& place, const MatrixF& effectors, double rate) {
            const auto clip = primitives.find(place.name);
            if (clip == primitives.end()) return;
            const MatrixF positions = joint_positions(resample(stored.read(place.name).clip, rate));
            rows_of_class[place.clip_class].add(clip->second, effectors, positions);
        });
    std::vector<ClassVariances> classes;
    for (const auto& [name, rows] : rows_of_class) {
        auto clusters =
            cluster_variances(rows.features, rows.point_clouds, rows.primitives, rows.clusters);
        std::erase_if(clusters, [](const ClusterVariance& one) { return one.primitives < 2; });
        classes.push_back({name, std::move(clusters)});
    }
    return classes;
}

Table variance_table(const std::vector<ClassVariances>& classes) {
    Table table{{"class", "cluster", "primitives", "point_clouds_mean", "point_clouds_variance",
                 "features_mean", "features_variance", "frames_mean", "frames_variance"},
                {}};
    for (const auto& [name, clusters] : classes) {
        for (const ClusterVariance& one : clusters) {
            table.rows.push_back({name, int64_t{one.cluster}, one.primitives, one.point_clouds.mean,
                                  one.point_clouds.variance, one.features.mean,
                                  one.features.variance, one.frames.mean, one.frames.variance});
        }
    }
    return table;
}

}  // namespace kinetome
