#include "kinetome/stages/corpus_shape.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <regex>
#include <utility>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/features/pose_vector.h"
#include "kinetome/formats/asf_amc.h"

namespace kinetome {
namespace {

ClassShape shape_of(const Skeleton& skeleton) {
    return {skeleton.class_name(), skeleton.joint_count(), skeleton.dof_count(),
            static_cast<int64_t>(pose_vector_columns(skeleton).size())};
}

/// From "<joints>j<dofs>d-…" (Skeleton::class_name).
ClassShape shape_of(const std::string& class_name) {
    ClassShape shape;
    shape.name = class_name;
    const char* const end = class_name.data() + class_name.size();
    const auto joints = std::from_chars(class_name.data(), end, shape.joints);
    if (joints.ptr != end) std::from_chars(joints.ptr + 1, end, shape.dofs);
    shape.pose_columns = shape.dofs;
    return shape;
}

/// Position of a class in the list, where it is entered when it is new.
size_t enter(ClassShape shape, std::vector<ClassShape>& classes) {
    const auto known = std::find_if(classes.begin(), classes.end(), [&](const ClassShape& other) {
        return other.name == shape.name;
    });
    if (known != classes.end()) return static_cast<size_t>(known - classes.begin());
    classes.push_back(std::move(shape));
    return classes.size() - 1;
}

/// Nothing when its takes will be quarantined.
std::optional<ClassShape> read_skeleton(const Survey& survey, const std::string& source) {
    try {
        return shape_of(parse_asf(read_source_file(survey.corpus / source), source));
    } catch (const InputError&) {
        return std::nullopt;
    }
}

/// Takes that hold their own skeleton are taken to be of the class of most others.
void guess_classes(CorpusShape& corpus, const std::vector<size_t>& unknown) {
    if (unknown.empty()) return;
    if (corpus.classes.empty()) corpus.classes.emplace_back();
    std::vector<int64_t> count(corpus.classes.size());
    for (const ClipShape& clip : corpus.clips) ++count[clip.clip_class];
    const auto most = std::max_element(count.begin(), count.end()) - count.begin();
    for (const size_t i : unknown) corpus.clips[i].clip_class = static_cast<size_t>(most);
}

}  // namespace

double values_of_frames(const ClassShape& shape) {
    return static_cast<double>(shape.dofs + 3 * shape.joints);
}

double values_of_features(const ClassShape& shape, const FeatureOptions& options, double rate) {
    return (static_cast<double>(shape.pose_columns + 3 * shape.joints) * options.pose_rate +
            effector_values * options.effector_rate) /
           rate;
}

int64_t ClipShape::frames_at(double other_rate) const {
    return std::max<int64_t>(1, std::llround(static_cast<double>(frames) * other_rate / rate));
}

double expected_edges(const ClipShape& clip, const ReindexOptions& options) {
    // A take returns to a pose the more seldom, the longer it is: fitted to the takes of the CMU
    // corpus at r = 72 cm.
    constexpr double share_after_a_second = 1.1, fitted_radius = 72;
    const NeighborOptions& asked = options.neighbors;
    const auto frames = static_cast<double>(clip.frames_at(options.features.effector_rate));
    const double seconds = frames / options.features.effector_rate;
    const double share =
        share_after_a_second / std::sqrt(seconds) * std::pow(asked.knn.radius / fitted_radius, 2);
    const double within_radius = frames * std::min(share, 1.0);
    const auto most = static_cast<double>(asked.knn.neighbours);
    return frames * std::max(1.0, most * (1 - std::exp(-within_radius / most)));
}

double expected_corpus_edges(const ClipShape& clip, int64_t class_frames,
                             const ReindexOptions& options) {
    return static_cast<double>(clip.frames_at(options.features.effector_rate)) *
           static_cast<double>(std::min(options.neighbors.knn.neighbours, class_frames));
}

std::vector<int64_t> CorpusShape::class_frames_at(double rate) const {
    std::vector<int64_t> frames_of_class(classes.size());
    for (const ClipShape& clip : clips) frames_of_class[clip.clip_class] += clip.frames_at(rate);
    return frames_of_class;
}

int64_t CorpusShape::frames() const {
    int64_t total = 0;
    for (const ClipShape& clip : clips) total += clip.frames;
    return total;
}

int64_t PartitionShape::most_clusters() const {
    return *std::max_element(cluster_counts.begin(), cluster_counts.end());
}

int64_t PartitionShape::expected_components() const {
    // A line through the subjects of the CMU corpus, by the logarithm of their frames.
    const double components = 1.15 * std::log2(static_cast<double>(std::max<int64_t>(rows, 2))) - 6;
    return std::clamp<int64_t>(std::llround(components), 1, std::max<int64_t>(pose_columns, 1));
}

CorpusShape corpus_shape(const Survey& survey, const std::vector<Shard>& shards,
                         const ReindexOptions& options) {
    CorpusShape corpus;
    std::map<std::string, std::optional<ClassShape>> skeletons;
    std::vector<size_t> unknown;
    for (const Shard& shard : shards) {
        std::vector<size_t>& members = corpus.shards[shard.cut];
        for (const size_t i : shard.clips) {
            const Take& take = survey.takes[i];
            if (!take.quarantined.empty() || take.claimed_frames == 0) continue;
            ClipShape clip{.name = take.name,
                           .source = take.source,
                           .clip_class = 0,
                           .frames = take.claimed_frames,
                           .rate = options.frames.amc.rate,
                           .source_bytes = take.bytes};
            if (take.skeleton_source.empty()) {
                unknown.push_back(corpus.clips.size());
            } else {
                const auto [skeleton, is_new] = skeletons.try_emplace(take.skeleton_source);
                if (is_new) skeleton->second = read_skeleton(survey, take.skeleton_source);
                if (!skeleton->second) continue;
                clip.clip_class = enter(*skeleton->second, corpus.classes);
            }
            members.push_back(corpus.clips.size());
            corpus.clips.push_back(std::move(clip));
        }
    }
    guess_classes(corpus, unknown);
    return corpus;
}

CorpusShape corpus_shape(const Catalog& catalog) {
    CorpusShape corpus;
    for (const CatalogClip& clip : catalog.clips) {
        if (!clip.indexed()) continue;
        corpus.shards[clip.shard].push_back(corpus.clips.size());
        corpus.clips.push_back({.name = clip.name,
                                .source = clip.source,
                                .clip_class = enter(shape_of(clip.clip_class), corpus.classes),
                                .frames = clip.frames,
                                .rate = clip.rate,
                                .source_bytes = 0});
    }
    return corpus;
}

std::vector<PartitionShape> partition_shapes(const CorpusShape& corpus,
                                             const ReindexOptions& options) {
    const double pose_rate = options.features.pose_rate;
    std::vector<int64_t> class_rows(corpus.classes.size());
    for (const ClipShape& clip : corpus.clips) {
        class_rows[clip.clip_class] += clip.frames_at(pose_rate);
    }
    std::optional<std::regex> pattern;
    if (!options.partition.subject_from.empty()) pattern.emplace(options.partition.subject_from);

    std::map<std::pair<size_t, std::string>, std::vector<ClipExtent>> members;
    for (const ClipShape& clip : corpus.clips) {
        const bool by_subject =
            partition_by_subject(options.partition.rule, class_rows[clip.clip_class]);
        const std::string part = by_subject ? "/" + subject_of(clip.source, pattern) : "";
        members[{clip.clip_class, part}].push_back(
            {hash_name(clip.name), clip.frames, clip.frames_at(pose_rate)});
    }
    std::vector<PartitionShape> partitions;
    for (const auto& [key, extents] : members) {
        const PieceLayout layout = layout_pieces(extents);
        if (layout.rows() < 2) continue;
        partitions.push_back(
            {.clips = static_cast<int64_t>(extents.size()),
             .rows = layout.rows(),
             .pieces = static_cast<int64_t>(layout.pieces.size()),
             .pose_columns = corpus.classes[key.first].pose_columns,
             .cluster_counts = cluster_counts(options.pose_clusters, layout.rows())});
    }
    return partitions;
}

std::vector<HierarchyShape> hierarchy_shapes(const CorpusShape& corpus,
                                             const ReindexOptions& options) {
    constexpr int64_t principal_markers = 12;  // of 31, at the default tolerance
    std::vector<std::vector<ClipExtent>> extents(corpus.classes.size());
    for (const ClipShape& clip : corpus.clips) {
        extents[clip.clip_class].push_back(
            {hash_name(clip.name), clip.frames, clip.frames_at(options.features.pose_rate)});
    }
    std::vector<HierarchyShape> shapes;
    for (size_t i = 0; i < extents.size(); ++i) {
        const PieceLayout layout = layout_pieces(extents[i]);
        const int64_t joints = corpus.classes[i].joints;
        if (layout.rows() == 0) continue;
        shapes.push_back({static_cast<int64_t>(extents[i].size()),
                          static_cast<int64_t>(layout.pieces.size()),
                          {layout.rows(), 3 * joints, 3 * std::min(principal_markers, joints),
                           static_cast<double>(layout.rows()) / options.features.pose_rate}});
    }
    return shapes;
}

bool goes_through_takes(std::string_view stage) {
    return stage == "segments" || stage == "primitives";
}

bool goes_through_bundles(std::string_view stage) {
    return stage == "bundles" || stage == "bundle_graph";
}

int64_t expected_letters(int64_t rows) {
    constexpr int64_t typical_frames_per_letter = 15;
    return rows / typical_frames_per_letter + 1;
}

}  // namespace kinetome
