#include "kinetome/stages/disk_need.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"
#include "kinetome/base/resources.h"
#include "kinetome/models/placed_signature.h"
#include "kinetome/models/signature_index.h"

namespace kinetome {
namespace {

/// Of real motion, before it is known; the file is small beside the sharded ones.
constexpr double typical_segment_seconds = 9, typical_primitive_seconds = 2.4;

/// Bytes of datasets that are there once a class or a partition.
class Group {
  public:
    Group& rows(int64_t count, std::initializer_list<int64_t> row_bytes) {
        for (const int64_t bytes : row_bytes) bytes_ += dataset_bytes(bytes, count);
        return *this;
    }
    uint64_t bytes() const { return bytes_; }

  private:
    uint64_t bytes_ = 0;
};

constexpr int64_t number = 8, index = 4, value = 4, name = 16;  // bytes of one

/// FrameShardWriter.
uint64_t frames_bytes(const ClassShape& shape, int64_t clips, int64_t frames) {
    return Group()
        .rows(shape.joints, {name, name, name, index, 1})
        .rows(clips, {number, number, number, name, name})
        .rows(clips,
              {3 * shape.joints * number, 3 * shape.joints * number, 9 * shape.joints * number})
        .rows(frames, {shape.dofs * value, 3 * shape.joints * value})
        .bytes();
}

/// FeatureShardWriter.
uint64_t features_bytes(const ClassShape& shape, int64_t clips, int64_t pose_rows,
                        int64_t effector_rows) {
    return Group()
        .rows(shape.pose_columns, {name, name, number})
        .rows(shape.joints, {name})
        .rows(1, {number, number})
        .rows(clips, {number, name, number, number, number, number})
        .rows(pose_rows, {shape.pose_columns * value, 3 * shape.joints * value})
        .rows(effector_rows, {effector_values * value})
        .bytes();
}

/// NeighborShardWriter.
uint64_t neighbors_bytes(int64_t clips, int64_t frames, int64_t edges,
                         std::initializer_list<int64_t> edge_bytes) {
    return Group()
        .rows(1, {number})
        .rows(clips, {number, name, number, number, number, number, number})
        .rows(frames, {index})
        .rows(edges, edge_bytes)
        .bytes();
}

uint64_t mixture_bytes(const PartitionShape& partition) {
    return static_cast<uint64_t>(partition.most_clusters() * (partition.expected_components() + 2) *
                                 number);
}

/// write_pose_clusters.
uint64_t pose_clusters_bytes(const PartitionShape& partition, const MixtureOptions& options) {
    const int64_t clusters = partition.most_clusters();
    const int64_t components = partition.expected_components();
    return Group()
        .rows(partition.pose_columns, {number, number, number, components * number})
        .rows(clusters, {components * number, number, number})
        .rows(options.max_iterations, {number})
        .rows(1, {number, number, number})
        .bytes();
}

/// What motion_strings writes of a partition.
uint64_t motion_strings_bytes(const PartitionShape& partition) {
    constexpr int64_t word_bits = 64;
    const int64_t clusters = partition.most_clusters();
    const int64_t letters = expected_letters(partition.rows);
    return Group()
        .rows(partition.clips, {number, name, number, number, number})
        .rows(letters, {index, number, index, index, number})
        .rows(clusters, {(clusters + word_bits - 1) / word_bits * number})
        .rows(1, {number, number, number})
        .bytes();
}

/// write_pose_hierarchy.
uint64_t pose_hierarchy_bytes(const HierarchyShape& shape, const PoseHierarchyOptions& options) {
    const HierarchySize& size = shape.size;
    const int64_t leaves = expected_leaves(size, options);
    return Group()
        .rows(size.columns / 3, {name})
        .rows(size.principal, {index, index})
        .rows(1, {number, index, number, number, number})
        .rows(2 * leaves - 1,
              {index, index, index, index, number, number, number, size.principal * number})
        .rows(leaves, {size.columns * number, size.columns * options.dimension * number, number,
                       size.principal * (size.columns - size.principal) * number})
        .bytes();
}

/// write_signatures.
uint64_t signatures_bytes(const CorpusShape& corpus, const ReindexOptions& options) {
    constexpr int64_t typical_run_frames = 12;
    const SignatureIndexOptions index_options;
    uint64_t bytes = 0;
    for (const HierarchyShape& shape : hierarchy_shapes(corpus, options)) {
        const int64_t leaves = expected_leaves(shape.size, options.pose_hierarchy);
        const int64_t runs = shape.size.rows / typical_run_frames + 1;
        const int64_t samples =
            shape.size.rows / sample_stride(options.features.pose_rate) + shape.clips;
        const int64_t axes = signature_axis_count(shape.size.columns);
        // Those within reach are some twelfth of the leaves of few takes.
        const int64_t near = leaves * std::min<int64_t>(leaves / 12, index_options.near_leaves);
        bytes += Group()
                     .rows(1, {number, number, index})
                     .rows(shape.clips, {number, name, number, number, number, number})
                     .rows(shape.size.columns, {axes * value})
                     .rows(samples, {axes * value})
                     .rows(runs, {index, index, index, axes * value, index})
                     .rows(leaves, {number, number})
                     .rows(near, {index, value})
                     .bytes();
    }
    return bytes;
}

/// write_bundles and write_bundle_graph. Real and generated takes have much the same shares.
uint64_t bundle_files_bytes(const std::string& stage, const CorpusShape& corpus,
                            const std::vector<PartitionShape>& partitions) {
    constexpr double members_per_letter = 0.31, bundles_per_letter = 0.16;
    constexpr double nodes_per_letter = 0.07, edges_per_letter = 0.15, links_per_letter = 0.15;
    const bool are_linked = partitions.size() > 1;
    int64_t letters = 0;
    for (const PartitionShape& partition : partitions) letters += expected_letters(partition.rows);
    const auto share = [=](double per_letter) {
        return static_cast<int64_t>(per_letter * static_cast<double>(letters)) + 1;
    };
    const auto clips = static_cast<int64_t>(corpus.clips.size());
    Group group;
    if (stage == "bundles") {
        group.rows(clips, {number, name, name, number, number, number});
        group.rows(static_cast<int64_t>(partitions.size()), {2 * name}).rows(1, {number});
        group.rows(share(bundles_per_letter), {index, index});
        group.rows(share(members_per_letter), {index, number, index, index});
    } else {
        group.rows(share(bundles_per_letter), {index});
        group.rows(share(nodes_per_letter), {index, number, index});
        group.rows(share(edges_per_letter), {index, index, number, number});
        group.rows(are_linked ? share(links_per_letter) : 0, {index, index, number});
        group.rows(1, {number, number, number});
    }
    return group.bytes();
}

/// write_segments and write_primitives.
uint64_t take_cuts_bytes(const std::string& stage, const CorpusShape& corpus,
                         const ReindexOptions& options) {
    const auto clips = static_cast<int64_t>(corpus.clips.size());
    const bool primitives = stage == "primitives";
    double seconds = 0;
    for (const ClipShape& clip : corpus.clips) {
        seconds += static_cast<double>(clip.frames_at(options.features.effector_rate)) /
                   options.features.effector_rate;
    }
    const double typical = primitives ? typical_primitive_seconds : typical_segment_seconds;
    const auto cuts = clips + static_cast<int64_t>(seconds / typical);
    Group group;
    group.rows(1, {number}).rows(clips, {number, name, name, number, number, number});
    group.rows(cuts, {number, index, index, index, index});
    if (primitives) group.rows(cuts, {index});
    return group.bytes();
}

/// Clips and rows of one class in a shard.
struct ClassRows {
    int64_t clips = 0, frames = 0, pose_rows = 0, effector_rows = 0;
    double edges = 0;
};

uint64_t class_bytes(const std::string& stage, const ClassShape& shape, const ClassRows& rows) {
    if (stage == "frames") return frames_bytes(shape, rows.clips, rows.frames);
    if (stage == "features") {
        return features_bytes(shape, rows.clips, rows.pose_rows, rows.effector_rows);
    }
    const int64_t edges = std::llround(rows.edges);
    if (stage == "neighbors") {
        return neighbors_bytes(rows.clips, rows.effector_rows, edges, {index, value});
    }
    return neighbors_bytes(rows.clips, rows.effector_rows, edges, {number, index, value});
}

uint64_t shard_bytes(const std::string& stage, const std::string& cut, const CorpusShape& corpus,
                     const ReindexOptions& options) {
    const auto shard = corpus.shards.find(cut);
    if (shard == corpus.shards.end()) return 0;
    const auto class_frames = corpus.class_frames_at(options.features.effector_rate);
    std::map<size_t, ClassRows> classes;
    for (const size_t i : shard->second) {
        const ClipShape& clip = corpus.clips[i];
        ClassRows& rows = classes[clip.clip_class];
        ++rows.clips;
        rows.frames += clip.frames;
        rows.pose_rows += clip.frames_at(options.features.pose_rate);
        rows.effector_rows += clip.frames_at(options.features.effector_rate);
        rows.edges += stage == "neighbors"
                          ? expected_edges(clip, options)
                          : expected_corpus_edges(clip, class_frames[clip.clip_class], options);
    }
    uint64_t bytes = 0;
    for (const auto& [clip_class, rows] : classes) {
        bytes += class_bytes(stage, corpus.classes[clip_class], rows);
    }
    return bytes;
}

/// For each stage of the last generation, its bytes as a multiple of its layout's. Empty when that
/// cannot be told, or when the files are compressed another way now.
std::map<std::string, double> byte_corrections(const Generation& last,
                                               const ReindexOptions& options) {
    ReindexOptions earlier;
    try {
        const std::filesystem::path file = last.folder() / "config.toml";
        parse_configuration(read_file(file), file.string(), earlier);
    } catch (const Error&) {
        return {};
    }
    if (earlier.frames.compression != options.frames.compression) return {};
    const CorpusShape corpus = corpus_shape(last.catalog());
    std::map<std::string, uint64_t> expected, found;
    for (const Receipt& receipt : last.ledger().receipts) {
        expected[receipt.stage] += artifact_bytes(receipt.stage, receipt.shard, corpus, earlier);
        found[receipt.stage] += receipt.file.bytes;
    }
    std::map<std::string, double> corrections;
    for (const auto& [stage, bytes] : expected) {
        if (bytes > 0) {
            corrections[stage] = static_cast<double>(found[stage]) / static_cast<double>(bytes);
        }
    }
    return corrections;
}

/// A level a file: together the models, and as much again of what levels hand down.
DiskNeed hierarchy_checkpoints(const CorpusShape& corpus, const ReindexOptions& options) {
    DiskNeed need;
    for (const HierarchyShape& shape : hierarchy_shapes(corpus, options)) {
        const auto leaves =
            static_cast<uint64_t>(expected_leaves(shape.size, options.pose_hierarchy));
        need.bytes += 2 * leaves * leaf_bytes(shape.size, options.pose_hierarchy);
        need.inodes += 24;
    }
    return need;
}

/// Models after the last iteration of every partition, and one more while a file is replaced.
DiskNeed checkpoints(const CorpusShape& corpus, const ReindexOptions& options) {
    const bool keeps_best = options.pose_clusters.mixture.restarts > 1 ||
                            options.pose_clusters.count_rule == ClusterCountRule::bic;
    DiskNeed need;
    uint64_t largest = 0;
    for (const PartitionShape& partition : partition_shapes(corpus, options)) {
        const uint64_t bytes = mixture_bytes(partition) * (keeps_best ? 3 : 1);
        need.bytes += bytes;
        ++need.inodes;
        largest = std::max(largest, bytes);
    }
    need.bytes += largest;
    ++need.inodes;
    return need;
}

/// Catalog, ledger, configuration and log of a generation; receipts and record of the run; locks
/// and folders.
DiskNeed texts(const RunPlan& plan) {
    constexpr uint64_t bytes_per_take = 2048, bytes_per_artifact = 4096, bytes_once = 16 * 1024;
    constexpr uint64_t inodes_once = 20;
    return {bytes_per_take * plan.survey.takes.size() + bytes_per_artifact * plan.work.size() +
                bytes_once,
            inodes_once};
}

}  // namespace

uint64_t artifact_bytes(const std::string& stage, const std::string& cut, const CorpusShape& corpus,
                        const ReindexOptions& options) {
    if (stage_named(stage).sharded) return shard_bytes(stage, cut, corpus, options);
    if (goes_through_takes(stage)) return take_cuts_bytes(stage, corpus, options);
    if (stage == "signatures") return signatures_bytes(corpus, options);
    if (goes_through_bundles(stage)) {
        return bundle_files_bytes(stage, corpus, partition_shapes(corpus, options));
    }
    uint64_t bytes = 0;
    if (stage == "pose_hierarchy") {
        for (const HierarchyShape& shape : hierarchy_shapes(corpus, options)) {
            bytes += pose_hierarchy_bytes(shape, options.pose_hierarchy);
        }
        return bytes;
    }
    for (const PartitionShape& partition : partition_shapes(corpus, options)) {
        if (stage == "pose_clusters") {
            bytes += pose_clusters_bytes(partition, options.pose_clusters.mixture);
        }
        if (stage == "motion_strings") bytes += motion_strings_bytes(partition);
    }
    return bytes;
}

std::vector<uint64_t> planned_bytes(const RunPlan& plan, const CorpusShape& corpus,
                                    const Generation* last) {
    std::map<std::string, double> corrections;
    if (last) corrections = byte_corrections(*last, plan.options);
    std::vector<uint64_t> bytes;
    for (const PlannedWork& work : plan.work) {
        const auto correction = corrections.find(work.stage->name);
        const double factor = correction == corrections.end() ? 1 : correction->second;
        const uint64_t layout = artifact_bytes(work.stage->name, work.shard ? work.shard->cut : "",
                                               corpus, plan.options);
        bytes.push_back(static_cast<uint64_t>(std::llround(static_cast<double>(layout) * factor)));
    }
    return bytes;
}

DiskNeed disk_need(const RunPlan& plan, const CorpusShape& corpus,
                   const std::vector<uint64_t>& planned_bytes, const std::vector<size_t>& to_make,
                   bool copies) {
    DiskNeed need;
    if (to_make.empty()) return need;
    const auto add = [&](const DiskNeed& more) {
        need.bytes += more.bytes;
        need.inodes += more.inodes;
    };
    bool clusters = false, hierarchies = false;
    for (const size_t i : to_make) {
        add({planned_bytes[i], 2});  // the file and its receipt
        clusters = clusters || plan.work[i].stage->name == "pose_clusters";
        hierarchies = hierarchies || plan.work[i].stage->name == "pose_hierarchy";
    }
    if (clusters) add(checkpoints(corpus, plan.options));
    if (hierarchies) add(hierarchy_checkpoints(corpus, plan.options));
    if (copies) {
        add({std::accumulate(planned_bytes.begin(), planned_bytes.end(), uint64_t{0}),
             planned_bytes.size()});
    }
    add(texts(plan));
    return need;
}

void require_room(const std::filesystem::path& store, const DiskNeed& need, const FreeSpace& free) {
    const auto refuse = [&](const std::string& needed, const std::string& left) {
        throw CreateError(
            fmt::format("{}: this run needs about {}, but only {} are free on its disk: free some "
                        "(`kinetome gc` drops old generations), or choose a store on another disk",
                        path_for_message(store.string()), needed, left));
    };
    if (need.bytes > free.bytes) refuse(describe_bytes(need.bytes), describe_bytes(free.bytes));
    if (free.inodes && need.inodes > *free.inodes) {
        refuse(fmt::format("{} files", need.inodes), fmt::format("{} inodes", *free.inodes));
    }
}

}  // namespace kinetome
