#include "kinetome/stages/signature_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/features/markers.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/resample.h"
#include "kinetome/models/match_rerank.h"
#include "kinetome/stages/pose_hierarchy_file.h"
#include "kinetome/stages/signature_file.h"
#include "kinetome/stages/take_file.h"
#include "kinetome/store/feature_store.h"

namespace kinetome {
namespace {

constexpr int64_t reranked = 60;    // matches that are looked at again
constexpr double rerank_rate = 30;  // frames a second

MatrixF in_mm_per_marker(const MatrixF& markers) {
    constexpr double mm_per_cm = 10;
    const auto compared = static_cast<double>(compared_markers(markers.cols()));
    return markers * static_cast<float>(mm_per_cm / std::sqrt(compared));
}

/// Markers of clips. A shard is opened when one of its clips is read first: opening reads all of
/// it, to verify it. Thread-safe.
class MarkerShards {
  public:
    /// `generation` outlives it.
    explicit MarkerShards(const Generation& generation) : generation_(generation) {}

    MatrixF read(const std::string& clip, const RowRange& frames) const {
        const auto& clips = generation_.catalog().clips;
        const auto known = std::ranges::lower_bound(clips, clip, {}, &CatalogClip::name);
        if (known != clips.end() && known->name == clip) {
            const FeatureShardReader& shard = shard_of(*known);
            const auto place = std::ranges::find(shard.clips(), clip, &FeatureShardClip::name);
            if (place != shard.clips().end()) {
                return shard.markers(place->clip_class, place->first_pose_row + frames.first,
                                     frames.size());
            }
        }
        throw StoreError(
            fmt::format("the markers of clip {} are not in the store", quote_for_message(clip)));
    }

  private:
    const FeatureShardReader& shard_of(const CatalogClip& clip) const {
        const std::scoped_lock one_opens(opening_);
        auto shard = shards_.find(clip.shard);
        if (shard == shards_.end()) {
            const auto made = generation_.made_by("features");
            const auto file = std::ranges::find(made, clip.shard, &Receipt::shard);
            if (file == made.end()) {
                throw StoreError(fmt::format("the features of shard {} are not in the store",
                                             quote_for_message(clip.shard)));
            }
            FeatureShardReader opened(generation_.open((*file)->file.file_name));
            shard = shards_.emplace(clip.shard, std::move(opened)).first;
        }
        return shard->second;
    }

    const Generation& generation_;
    mutable std::mutex opening_;
    mutable std::map<std::string, FeatureShardReader> shards_;  ///< by cut name
};

/// Source frames as frames at the pose rate, at least one.
RowRange at_pose_rate(const RowRange& frames, double source_rate, double pose_rate,
                      int64_t pose_frames) {
    const auto converted = [&](int64_t frame) {
        return std::llround(static_cast<double>(frame) * pose_rate / source_rate);
    };
    const int64_t first = std::clamp<int64_t>(converted(frames.first), 0, pose_frames - 1);
    return {first, std::clamp<int64_t>(converted(frames.end), first + 1, pose_frames)};
}

/// The frames asked for of so many.
RowRange asked_frames(const SignatureQuery& query, int64_t frames) {
    const RowRange asked = query.frames.value_or(RowRange{0, frames});
    if (asked.first < 0 || asked.first >= asked.end || asked.end > frames) {
        throw UsageError(
            fmt::format("--frames {}:{}: expected a part of 0:{}", asked.first, asked.end, frames));
    }
    return asked;
}

/// A motion to look for, and where.
struct Asked {
    ClassSignatures signatures;
    PlacedSignature signature;
    MatrixF markers;  ///< cm
};

Asked asked_clip(const Generation& generation, const SignatureQuery& query) {
    const ArtifactReader file = generation.open("signatures.h5");
    for (const std::string& group : signature_classes(file)) {
        ClassSignatures signatures = read_signatures(file, group);
        const auto clip =
            std::ranges::lower_bound(signatures.clips, query.clip, {}, &SignatureClip::name);
        if (clip == signatures.clips.end() || clip->name != query.clip) continue;
        const auto number = static_cast<int32_t>(clip - signatures.clips.begin());
        const RowRange frames = at_pose_rate(asked_frames(query, clip->source_frames),
                                             clip->source_rate, signatures.pose_rate, clip->frames);
        MatrixF markers = MarkerShards(generation).read(query.clip, frames);
        PlacedSignature signature = place_signature(
            part_of(signatures.index.signature(number), frames), markers, signatures.axes, 1);
        return {std::move(signatures), std::move(signature), std::move(markers)};
    }
    throw UsageError(
        fmt::format("no clip {} is indexed; kinetome export STORE clips lists those that are",
                    quote_for_message(query.clip)));
}

Asked asked_take(const Generation& generation, const SignatureQuery& query) {
    const Clip take = read_take_file(query.file);
    const std::string group = "/" + take.skeleton->class_name();
    const ArtifactReader file = generation.open("signatures.h5");
    const auto classes = signature_classes(file);
    if (std::ranges::find(classes, group) == classes.end()) {
        throw UsageError(fmt::format("{}: the store has no take of its class, {}",
                                     path_for_message(query.file.string()), group.substr(1)));
    }
    ClassSignatures signatures = read_signatures(file, group);
    const PoseHierarchy hierarchy =
        read_pose_hierarchy(generation.open("pose_hierarchy.h5"), group).hierarchy;
    const Clip clip = resample(take, signatures.pose_rate);
    const RowRange frames = at_pose_rate(asked_frames(query, take.frames()), take.rate,
                                         signatures.pose_rate, clip.frames());
    MatrixF markers = normalised_markers(*clip.skeleton, clip.motion, joint_positions(clip))
                          .middleRows(frames.first, frames.size());
    PlacedSignature signature =
        place_signature(make_signature(leaves_of(hierarchy, markers)), markers, signatures.axes, 1);
    return {std::move(signatures), std::move(signature), std::move(markers)};
}

std::vector<IndexedMatch> nearest_by_signature(const Asked& asked, const SignatureQuery& query,
                                               int64_t k) {
    SignatureSearchOptions options = query.search;
    options.to_the_frame = !query.rerank;  // which moves them itself
    options.match.step = asked.signatures.index.parts().stride;
    return asked.signatures.index.search(asked.signature, k, options);
}

std::vector<IndexedMatch> reranked_matches(const Generation& generation, const Asked& asked,
                                           const SignatureQuery& query, int threads) {
    const MarkerShards shards(generation);
    std::vector<int64_t> frames;
    for (const SignatureClip& clip : asked.signatures.clips) frames.push_back(clip.frames);
    RerankOptions options;
    options.stride = std::max<int64_t>(1, std::llround(asked.signatures.pose_rate / rerank_rate));
    options.overlap = query.search.match.overlap;
    return rerank_matches(
        in_mm_per_marker(asked.markers),
        nearest_by_signature(asked, query, std::max(reranked, query.answers)), frames,
        query.answers,
        [&](int32_t clip, const RowRange& some) {
            return in_mm_per_marker(
                shards.read(asked.signatures.clips[static_cast<size_t>(clip)].name, some));
        },
        options, threads);
}

}  // namespace

Table query_table(const Generation& generation, const SignatureQuery& query, int threads) {
    const Asked asked =
        query.file.empty() ? asked_clip(generation, query) : asked_take(generation, query);
    const auto matches = query.rerank ? reranked_matches(generation, asked, query, threads)
                                      : nearest_by_signature(asked, query, query.answers);
    Table table{{"rank", "clip", "first", "end", "distance"}, {}};
    for (const IndexedMatch& match : matches) {
        const auto rank = static_cast<int64_t>(table.rows.size()) + 1;
        table.rows.push_back(
            {rank, asked.signatures.clips[static_cast<size_t>(match.clip)].name,
             asked.signatures.source_boundary(match.clip, match.match.frames.first),
             asked.signatures.source_boundary(match.clip, match.match.frames.end),
             match.match.distance});
    }
    return table;
}

Table signature_table(const Generation& generation) {
    Table table{{"clip", "first", "end", "leaf"}, {}};
    const ArtifactReader file = generation.open("signatures.h5");
    for (const std::string& group : signature_classes(file)) {
        const ClassSignatures signatures = read_signatures(file, group);
        for (size_t i = 0; i < signatures.clips.size(); ++i) {
            const auto clip = static_cast<int32_t>(i);
            for (const SignatureRun& run : signatures.index.signature(clip)) {
                const int64_t first = signatures.source_boundary(clip, run.first_frame);
                const int64_t end = signatures.source_boundary(clip, run.end_frame());
                if (first == end) continue;  // a run shorter than a frame of the source
                table.rows.push_back({signatures.clips[i].name, first, end, int64_t{run.leaf}});
            }
        }
    }
    std::ranges::stable_sort(table.rows, {}, [](const auto& row) -> const std::string& {
        return std::get<std::string>(row.front());
    });
    return table;
}

}  // namespace kinetome
