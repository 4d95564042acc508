#include "kinetome/stages/stage_loads.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/stages/stage.h"

namespace kinetome {
namespace {

constexpr double nanosecond = 1e-9;

double fit_seconds(const PartitionShape& partition, const MixtureOptions& options,
                   const PoseRates& rates) {
    const auto rows = static_cast<double>(partition.rows);
    double seconds = 0;
    for (const int64_t clusters : partition.cluster_counts) {
        const ClusterRates each = rates_of_clusters(rates, clusters);
        const double drawn = std::min(rows, static_cast<double>(options.start_sample));
        const double steps = options.max_iterations + 1;  // one more tells the likelihood
        seconds += options.restarts *
                   (drawn * each.start_nanoseconds_per_row +
                    rows * steps * each.iteration_nanoseconds_per_row) *
                   nanosecond;
    }
    return seconds;
}

/// What a rank hands over and gets back: a few subtrees of sums, and the sum of all.
double fit_exchange(const PartitionShape& partition, const MixtureOptions& options) {
    constexpr double sums_an_iteration = 4;
    // Sums of an E step and the model they make.
    const auto bytes_per_cluster =
        static_cast<double>(partition.expected_components() + 2) * sizeof(double);
    double bytes = 0;
    for (const int64_t clusters : partition.cluster_counts) {
        bytes += static_cast<double>(clusters) * bytes_per_cluster * sums_an_iteration *
                 (options.max_iterations + 1) * options.restarts;
    }
    return bytes;
}

LoadItem clusters_item(const PartitionShape& partition, const ReindexOptions& options,
                       const PoseRates& rates) {
    const auto rows = static_cast<double>(partition.rows);
    const MixtureOptions& mixture = options.pose_clusters.mixture;
    LoadItem item;
    item.amount = partition.rows;
    item.pieces = partition.pieces;
    item.seconds = rows *
                       (rates.moments_nanoseconds_per_row + rates.projection_nanoseconds_per_row) *
                       nanosecond +
                   fit_seconds(partition, mixture, rates);
    item.exchanged_bytes = fit_exchange(partition, mixture);
    return item;
}

LoadItem strings_item(const PartitionShape& partition, const PoseRates& rates) {
    const auto rows = static_cast<double>(partition.rows);
    const auto clusters = static_cast<double>(partition.most_clusters());
    const ClusterRates each = rates_of_clusters(rates, partition.most_clusters());
    LoadItem item;
    item.amount = partition.rows;
    item.pieces = partition.pieces;
    item.seconds =
        (rows * (rates.projection_nanoseconds_per_row + each.letter_nanoseconds_per_row) +
         clusters * clusters * rates.accessibility_nanoseconds_per_pair) *
        nanosecond;
    item.exchanged_bytes = rows * sizeof(int32_t);
    return item;
}

/// Levels, as long as nothing is grown: those of a balanced tree.
double expected_levels(const HierarchyShape& shape, const PoseHierarchyOptions& options) {
    return 1 + std::log2(static_cast<double>(expected_leaves(shape.size, options)));
}

LoadItem hierarchy_item(const HierarchyShape& shape, const PoseHierarchyOptions& options,
                        const ShardRates& rates) {
    const auto leaves = static_cast<double>(expected_leaves(shape.size, options));
    LoadItem item;
    item.amount = shape.size.rows;
    item.pieces = shape.pieces;
    item.seconds = static_cast<double>(shape.size.rows) * expected_levels(shape, options) *
                   rates.nanoseconds_per_value * nanosecond;
    // Second moments of every node, which are twice as many as leaves.
    item.exchanged_bytes =
        leaves * static_cast<double>(shape.size.columns * shape.size.columns) * sizeof(double);
    return item;
}

const ShardRates& shard_rates(const std::string& stage, const Rates& rates) {
    if (stage == "frames") return rates.frames;
    if (stage == "segments") return rates.segments;
    if (stage == "bundles") return rates.bundles;
    if (stage == "bundle_graph") return rates.bundle_graph;
    if (stage == "primitives") return rates.primitives;
    if (stage == "signatures") return rates.signatures;
    if (stage == "features") return rates.features;
    return stage == "neighbors" ? rates.neighbors : rates.corpus_neighbors;
}

/// A stage that makes one file of what ranks find out take by take, at `rate` frames a second.
StageLoad load_of_takes(const ShardRates& each, const CorpusShape& corpus, double rate) {
    StageLoad load;
    load.serial_share = each.serial_share;
    for (const ClipShape& clip : corpus.clips) {
        LoadItem item;
        item.amount = clip.frames_at(rate);
        item.seconds = static_cast<double>(item.amount) * each.nanoseconds_per_value * nanosecond;
        load.items.push_back(item);
    }
    if (!load.items.empty()) load.items.front().fixed_seconds = each.seconds_per_file;
    return load;
}

/// Each partition is the work of one rank.
StageLoad load_of_bundles(const ShardRates& each, const std::vector<PartitionShape>& partitions) {
    StageLoad load;
    load.serial_share = each.serial_share;
    for (const PartitionShape& partition : partitions) {
        LoadItem item;
        item.amount = partition.rows;
        item.seconds =
            static_cast<double>(partition.rows) * each.nanoseconds_per_value * nanosecond;
        load.items.push_back(item);
    }
    if (!load.items.empty()) load.items.front().fixed_seconds = each.seconds_per_file;
    return load;
}

/// Numbers that a sharded stage writes of a clip, those of one that takes longer counted as more.
double values_of(const std::string& stage, const ClipShape& clip, const CorpusShape& corpus,
                 int64_t class_frames, const ReindexOptions& options) {
    const ClassShape& shape = corpus.class_of(clip);
    const auto frames = static_cast<double>(clip.frames);
    if (stage == "frames") return frames * values_of_frames(shape);
    if (stage == "features") {
        return frames * values_of_features(shape, options.features, clip.rate);
    }
    if (stage == "neighbors") return 2 * expected_edges(clip, options);
    return 3 * expected_corpus_edges(clip, class_frames, options) *
           crowding(static_cast<double>(class_frames));
}

/// What is searched again for every shard of the graph of all takes.
double searched_seconds(const CorpusShape& corpus, const ReindexOptions& options,
                        const Rates& rates) {
    const auto frames = corpus.class_frames_at(options.features.effector_rate);
    const int64_t rows = std::accumulate(frames.begin(), frames.end(), int64_t{0});
    return static_cast<double>(rows) * rates.search.nanoseconds_per_row * nanosecond;
}

}  // namespace

LoadItem shard_item(const std::string& stage, const std::string& cut, const CorpusShape& corpus,
                    const ReindexOptions& options, const Rates& rates) {
    LoadItem item;
    double values = 0;
    const auto class_frames = corpus.class_frames_at(options.features.effector_rate);
    const auto shard = corpus.shards.find(cut);
    if (shard != corpus.shards.end()) {
        item.pieces = std::max<int64_t>(1, static_cast<int64_t>(shard->second.size()));
        for (const size_t i : shard->second) {
            const ClipShape& clip = corpus.clips[i];
            item.amount += clip.frames;
            values += values_of(stage, clip, corpus, class_frames[clip.clip_class], options);
        }
    }
    const ShardRates& each = shard_rates(stage, rates);
    item.seconds = values * each.nanoseconds_per_value * nanosecond;
    if (stage == "corpus_neighbors") item.seconds += searched_seconds(corpus, options, rates);
    item.fixed_seconds = each.seconds_per_file;
    return item;
}

StageLoad stage_load(const std::string& stage, const CorpusShape& corpus,
                     const ReindexOptions& options, const Rates& rates) {
    StageLoad load;
    if (stage_named(stage).sharded) {
        load.serial_share = shard_rates(stage, rates).serial_share;
        for (const auto& [cut, clips] : corpus.shards) {
            load.items.push_back(shard_item(stage, cut, corpus, options, rates));
        }
        return load;
    }
    if (goes_through_takes(stage)) {
        return load_of_takes(shard_rates(stage, rates), corpus, options.features.effector_rate);
    }
    if (stage == "signatures") {
        return load_of_takes(rates.signatures, corpus, options.features.pose_rate);
    }
    if (goes_through_bundles(stage)) {
        const auto partitions = partition_shapes(corpus, options);
        ShardRates each = shard_rates(stage, rates);
        // What takes long there is to link the bundles of several.
        if (stage == "bundle_graph" && partitions.size() < 2) each.nanoseconds_per_value /= 500;
        load = load_of_bundles(each, partitions);
        // Bundles are linked by all ranks, whichever partition they are of.
        load.shares_items = stage == "bundle_graph";
        return load;
    }
    load.shares_items = true;
    if (stage == "pose_hierarchy") {
        load.serial_share = rates.pose_hierarchy.serial_share;
        for (const HierarchyShape& shape : hierarchy_shapes(corpus, options)) {
            load.items.push_back(
                hierarchy_item(shape, options.pose_hierarchy, rates.pose_hierarchy));
        }
        if (!load.items.empty()) {
            load.items.front().fixed_seconds = rates.pose_hierarchy.seconds_per_file;
        }
        return load;
    }
    load.serial_share = rates.poses.serial_share;
    for (const PartitionShape& partition : partition_shapes(corpus, options)) {
        load.items.push_back(stage == "pose_clusters"
                                 ? clusters_item(partition, options, rates.poses)
                                 : strings_item(partition, rates.poses));
    }
    if (!load.items.empty()) load.items.front().fixed_seconds = rates.poses.seconds_per_file;
    return load;
}

std::map<std::string, double> second_corrections(const Generation& generation, const Rates& rates) {
    constexpr double least_believed = 0.25;
    ReindexOptions options;
    try {
        const std::filesystem::path file = generation.folder() / "config.toml";
        parse_configuration(read_file(file), file.string(), options);
    } catch (const Error&) {
        return {};
    }
    const CorpusShape corpus = corpus_shape(generation.catalog());
    std::map<std::string, double> corrections;
    for (const StageRow& stage : stage_table()) {
        double taken = 0;
        for (const Receipt* receipt : generation.ledger().of_stage(stage.name)) {
            // One thread takes the processor's seconds, and no less than those on the wall.
            taken += std::max(receipt->cost.cpu_seconds, receipt->cost.seconds);
        }
        const double expected = load_seconds(stage_load(stage.name, corpus, options, rates), 1, 1);
        if (taken > 0 && expected > 0) {
            corrections[stage.name] = std::max(taken / expected, least_believed);
        }
    }
    return corrections;
}

}  // namespace kinetome
