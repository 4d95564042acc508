#include "kinetome/stages/peak_memory.h"

#include <algorithm>
#include <vector>

#include "clip_pipeline.h"
#include "kinetome/models/bundle_graph.h"
#include "kinetome/models/bundle_link_rows.h"
#include "kinetome/models/neighbor_graph.h"
#include "kinetome/models/placed_signature.h"
#include "kinetome/models/pose_clusters.h"
#include "kinetome/models/signature_index.h"
#include "kinetome/stages/graph_rows.h"
#include "kinetome/stages/stage.h"
#include "kinetome/stages/work_share.h"

namespace kinetome {
namespace {

constexpr uint64_t program_bytes = 32 << 20;  // code, libraries, what the heap does not give back
constexpr uint64_t bytes_per_clip = 2048;     // of survey, catalog and ledger

uint64_t bytes_of(double values) {
    return static_cast<uint64_t>(values * sizeof(float));
}

/// A clip on its way.
uint64_t clip_bytes(const std::string& stage, const ClipShape& clip, const ClassShape& shape,
                    const ReindexOptions& options) {
    if (stage == "neighbors" || goes_through_takes(stage)) {
        return neighbor_graph_bytes(clip.frames_at(options.features.effector_rate),
                                    3 * effector_values, options.neighbors.knn);
    }
    const double frame = values_of_frames(shape);
    const double feature = values_of_features(shape, options.features, clip.rate);
    return static_cast<uint64_t>(clip.frames) *
           bytes_of(stage == "frames" ? frame : frame + feature);
}

/// Clips on their way from reading to writing: the largest of the corpus at once, at worst.
uint64_t pipeline_bytes(const std::string& stage, const CorpusShape& corpus,
                        const ReindexOptions& options, const Resources& resources) {
    std::vector<uint64_t> sizes, sources;
    for (const ClipShape& clip : corpus.clips) {
        sizes.push_back(clip_bytes(stage, clip, corpus.class_of(clip), options));
        sources.push_back(clip.source_bytes);
    }
    std::sort(sizes.rbegin(), sizes.rend());
    std::sort(sources.rbegin(), sources.rend());
    uint64_t bytes = 0;
    const size_t in_flight = clips_in_flight(resources, sizes.empty() ? 0 : sizes.front());
    for (size_t i = 0; i < std::min(in_flight, sizes.size()); ++i) bytes += sizes[i];
    if (stage != "frames") return bytes;
    const auto parsing = static_cast<size_t>(resources.threads);
    for (size_t i = 0; i < std::min(parsing, sources.size()); ++i) bytes += sources[i];
    return bytes;
}

/// Features of all takes side by side, in which rank 0 compares primitives of different takes.
uint64_t graph_feature_bytes(const CorpusShape& corpus, const ReindexOptions& options) {
    double frames = 0;
    for (const ClipShape& clip : corpus.clips) {
        frames += static_cast<double>(clip.frames_at(options.features.effector_rate));
    }
    return bytes_of(frames * 3 * effector_values);
}

/// Queries and the rows they are compared with: at most a shard, or a clip, and all of a class.
uint64_t search_bytes(const CorpusShape& corpus, const ReindexOptions& options,
                      const Resources& resources) {
    const GraphSearchSize size(options, resources);
    const double rate = options.features.effector_rate;
    int64_t largest_shard = 0, largest_clip = 0, largest_class = 0;
    for (const auto& [cut, clips] : corpus.shards) {
        int64_t rows = 0;
        for (const size_t i : clips) {
            const int64_t of_clip = corpus.clips[i].frames_at(rate);
            rows += of_clip;
            largest_clip = std::max(largest_clip, of_clip);
        }
        largest_shard = std::max(largest_shard, rows);
    }
    for (const int64_t frames : corpus.class_frames_at(rate)) {
        largest_class = std::max(largest_class, frames);
    }
    const int64_t queries = std::max(largest_clip, std::min(largest_shard, size.queries));
    return static_cast<uint64_t>(queries) * size.bytes_per_query +
           static_cast<uint64_t>(std::min(largest_class, size.rows)) * size.bytes_per_row;
}

/// What rank 0 holds of every partition until the file is written.
uint64_t result_bytes(const std::string& stage, const PartitionShape& partition) {
    const int64_t clusters = partition.most_clusters();
    if (stage == "motion_strings") {
        return static_cast<uint64_t>(clusters * ((clusters + 63) / 64)) * sizeof(uint64_t);
    }
    return static_cast<uint64_t>(clusters * (partition.expected_components() + 2)) * sizeof(double);
}

/// A partition that is worked on by one rank, or its share at each of several.
uint64_t partition_bytes(const std::string& stage, const PartitionShape& partition,
                         const ReindexOptions& options, const Resources& resources, int ranks) {
    const auto rows = static_cast<uint64_t>(partition.rows);
    if (stage == "motion_strings") return rows * sizeof(int32_t) + result_bytes(stage, partition);
    const uint64_t kept = rows / static_cast<uint64_t>(ranks) *
                          bytes_of(static_cast<double>(partition.expected_components()));
    return kept + fitting_bytes(partition.rows, partition.expected_components(), partition.pieces,
                                options.pose_clusters, resources.threads, ranks);
}

/// Growth of the largest hierarchy, and all of them until the file is written.
uint64_t hierarchy_bytes(const CorpusShape& corpus, const ReindexOptions& options,
                         const Resources& resources, int ranks) {
    uint64_t largest = 0, results = 0;
    for (const HierarchyShape& shape : hierarchy_shapes(corpus, options)) {
        const HierarchySize& size = shape.size;
        const auto share = static_cast<uint64_t>(size.rows / ranks) * sizeof(float);
        const int64_t nodes = expected_leaves(size, options.pose_hierarchy);
        largest =
            std::max(largest, growth_bytes(size, options.pose_hierarchy) +
                                  share * static_cast<uint64_t>(size.columns + size.principal) +
                                  static_cast<uint64_t>(std::min<int64_t>(nodes, 2048)) *
                                      pass_bytes_per_node(size.columns, resources.threads));
        results += static_cast<uint64_t>(nodes) * leaf_bytes(size, options.pose_hierarchy);
    }
    return largest + results;
}

/// Markers of clips on their way, a model, and the index of every class until the file is written.
uint64_t signature_bytes(const CorpusShape& corpus, const ReindexOptions& options,
                         const Resources& resources) {
    constexpr int64_t bytes_per_run = 64, typical_run_frames = 12, bytes_per_near_leaf = 16;
    const SignatureIndexOptions index_options;
    uint64_t model = 0, indices = 0;
    for (const HierarchyShape& shape : hierarchy_shapes(corpus, options)) {
        const int64_t leaves = expected_leaves(shape.size, options.pose_hierarchy);
        model = std::max(model, 2 * static_cast<uint64_t>(leaves) *
                                    leaf_bytes(shape.size, options.pose_hierarchy));
        // Twice: those of each clip are brought together.
        const int64_t position_bytes =
            2 * signature_axis_count(shape.size.columns) * int64_t{sizeof(float)};
        const int64_t samples =
            shape.size.rows / sample_stride(options.features.pose_rate) + shape.clips;
        indices += static_cast<uint64_t>(
            shape.size.rows / typical_run_frames * (bytes_per_run + position_bytes) +
            samples * position_bytes +
            leaves * (index_options.near_leaves * bytes_per_near_leaf + position_bytes));
    }
    return model + indices + pipeline_bytes("signatures", corpus, options, resources);
}

/// A string, its accessibility and reach tables, poses at the ends of members; all members until
/// the file is written.
uint64_t bundle_bytes(const CorpusShape& corpus, const ReindexOptions& options,
                      const Resources& resources) {
    constexpr uint64_t bytes_per_letter = 256, table_bytes_per_letter = 2048;
    uint64_t largest = 0, letters = 0;
    for (const PartitionShape& partition : partition_shapes(corpus, options)) {
        const auto here = static_cast<uint64_t>(expected_letters(partition.rows));
        const uint64_t tables =
            std::min(BundleResources().table_bytes,
                     std::min(here * table_bytes_per_letter, resources.memory_bytes / 4));
        const uint64_t poses = static_cast<uint64_t>(partition.rows) *
                               bytes_of(static_cast<double>(partition.expected_components()));
        largest = std::max(largest, here * bytes_per_letter + tables + poses +
                                        2 * result_bytes("motion_strings", partition));
        letters += here;
    }
    return largest + letters * sizeof(BundleMember);
}

/// Rows by which bundles of subjects are compared, as read and along their main axes, and as ranks
/// tell each other of them.
uint64_t link_bytes(const CorpusShape& corpus, int ranks) {
    const uint64_t bytes_per_row = (ranks > 1 ? 4 : 2) * 99 * sizeof(float);
    uint64_t rows = 0;
    for (const ClipShape& clip : corpus.clips)
        rows += static_cast<uint64_t>(clip.frames_at(bundle_link_rate));
    return rows * bytes_per_row;
}

}  // namespace

uint64_t peak_memory(const std::string& stage, const CorpusShape& corpus,
                     const ReindexOptions& options, const Resources& resources, int ranks) {
    const uint64_t at_rest = program_bytes + corpus.clips.size() * bytes_per_clip;
    if (stage == "corpus_neighbors") {
        return at_rest + search_bytes(corpus, options, resources);
    }
    if (stage_named(stage).sharded) {
        return at_rest + pipeline_bytes(stage, corpus, options, resources);
    }
    if (goes_through_takes(stage)) {
        const uint64_t takes = at_rest + pipeline_bytes(stage, corpus, options, resources);
        return stage == "primitives" ? takes + graph_feature_bytes(corpus, options) : takes;
    }
    if (stage == "signatures") return at_rest + signature_bytes(corpus, options, resources);
    if (stage == "pose_hierarchy") {
        return std::min(at_rest + hierarchy_bytes(corpus, options, resources, ranks),
                        std::max(resources.memory_bytes, at_rest));
    }
    if (stage == "bundle_graph") {
        return at_rest + bundle_bytes(corpus, options, resources) + link_bytes(corpus, ranks) +
               pipeline_bytes("features", corpus, options, resources);
    }
    if (stage == "bundles") return at_rest + bundle_bytes(corpus, options, resources);
    const auto partitions = partition_shapes(corpus, options);
    std::vector<int64_t> rows;
    for (const PartitionShape& partition : partitions) rows.push_back(partition.rows);
    const std::vector<int> owners = share_out(rows, ranks, true);
    uint64_t largest = 0, results = 0;
    for (size_t i = 0; i < partitions.size(); ++i) {
        const int sharing = owners[i] == all_ranks ? ranks : 1;
        results += result_bytes(stage, partitions[i]);
        largest =
            std::max(largest, partition_bytes(stage, partitions[i], options, resources, sharing));
    }
    return std::min(at_rest + largest + results, std::max(resources.memory_bytes, at_rest));
}

}  // namespace kinetome
