// How fast does this machine work? Writes the rates that `kinetome plan --rates FILE` makes its
// estimates of seconds from: every stage on a generated corpus, at one thread and at all.
//
//   stage_rates_bench [-o FILE] [--frames N] [--turns N] [--threads N]
//       -o         file to write (default: standard output)
//       --frames   of the corpus (default: 200000)
//       --turns    of each measurement, of which the least counts (default: 3)
//       --threads  that are "all" (default: what was granted)
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/random.h"
#include "kinetome/base/resources.h"
#include "kinetome/features/pose_vector.h"
#include "kinetome/math/knn.h"
#include "kinetome/math/mixture.h"
#include "kinetome/math/pca.h"
#include "kinetome/models/pose_clusters.h"
#include "kinetome/stages/corpus_shape.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/pose_hierarchy_file.h"
#include "kinetome/stages/rates.h"
#include "kinetome/stages/reindex.h"
#include "kinetome/store/feature_store.h"
#include "kinetome/store/neighbor_store.h"
#include "kinetome/synthesis/corpus_generator.h"
#include "program.h"
#include "support/temporary_folder.h"

namespace {

using namespace kinetome;
namespace fs = std::filesystem;

constexpr int64_t least_frames = 10'000;  // fewer take no time that could be measured

struct Options {
    fs::path output;
    int64_t frames = 200'000;
    int turns = 3;
    std::optional<int> threads;
};

/// What else the machine does only ever adds: the least of several turns is nearest to the work.
struct Least {
    double wall = std::numeric_limits<double>::infinity();
    double cpu = std::numeric_limits<double>::infinity();

    void enter(double wall_seconds, double cpu_seconds) {
        wall = std::min(wall, wall_seconds);
        cpu = std::min(cpu, cpu_seconds);
    }
    void time(const std::function<void()>& work) {
        const auto started = std::chrono::steady_clock::now();
        const double cpu_started = cpu_seconds();
        work();
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
        enter(elapsed.count(), cpu_seconds() - cpu_started);
    }
};

/// t(1) = s + p, t(n) = s + p / n: the share s / t(1).
double serial_share(double one, double all, int threads) {
    if (threads < 2) return 0;
    const double ideal = 1.0 / threads;
    return std::clamp((all / one - ideal) / (1 - ideal), 0.0, 1.0);
}

ReindexRequest request(const fs::path& corpus, const fs::path& store, const Resources& resources,
                       int threads) {
    ReindexRequest asked;
    asked.corpus = corpus;
    asked.store = store;
    asked.resources = resources;
    asked.resources.threads = threads;
    // One cluster: the mixture is measured by itself.
    asked.options.pose_clusters.clusters = 1;
    asked.options.pose_clusters.mixture.max_iterations = 1;
    asked.options.partition.rule = PartitionRule::none;
    asked.options.corpus_neighbors.wanted = true;
    return asked;
}

/// What bundles are made from: letters of each subject's own, as many as there usually are.
ReindexRequest request_of_bundles(const fs::path& corpus, const fs::path& store,
                                  const Resources& resources, int threads) {
    ReindexRequest asked = request(corpus, store, resources, threads);
    asked.options.pose_clusters = {};
    asked.options.partition.rule = PartitionRule::subject;
    asked.only = {"frames",         "features", "pose_clusters",
                  "motion_strings", "bundles",  "bundle_graph"};
    return asked;
}

/// Stages in table order, each made from nothing.
using StageTimes = std::vector<Least>;

void time_stages(const ReindexRequest& asked, StageTimes& times) {
    fs::remove_all(asked.store);
    const RunSummary summary = reindex(asked, Log(), {});
    times.resize(summary.stages.size());
    for (size_t i = 0; i < times.size(); ++i) {
        times[i].enter(summary.stages[i].cost.seconds, summary.stages[i].cost.cpu_seconds);
    }
}

/// Projected pose vectors of a store, clip after clip.
MatrixF projected_rows(const fs::path& store) {
    const OpenStore opened(store);
    std::vector<MatrixF> parts;
    int64_t count = 0;
    std::vector<double> floors;
    for (const Receipt* receipt : opened.generation.ledger().of_stage("features")) {
        const FeatureShardReader shard(opened.generation.open(receipt->file.file_name));
        for (const FeatureShardClip& clip : shard.clips()) {
            parts.push_back(
                shard.pose_vectors(clip.clip_class, clip.first_pose_row, clip.pose_rows));
            floors = shard.feature_class(clip.clip_class).pose_vector_floors;
            count += clip.pose_rows;
        }
    }
    MatrixF rows(count, parts.front().cols());
    int64_t first = 0;
    for (const MatrixF& part : parts) {
        rows.middleRows(first, part.rows()) = part;
        first += part.rows();
    }
    const VectorD least = Eigen::Map<const VectorD>(floors.data(), rows.cols());
    const Pca pca = fit_pca(moments_of(rows), least, PoseClusterOptions().variance_share);
    return pca.project(rows);
}

/// What a stage left in the graphs of a store.
struct GraphSize {
    double frames = 0;
    double edges = 0;
};

GraphSize size_of_graphs(const Generation& generation, const std::string& stage) {
    GraphSize size;
    for (const Receipt* receipt : generation.ledger().of_stage(stage)) {
        const NeighborShardReader shard(generation.open(receipt->file.file_name));
        for (const NeighborShardClip& clip : shard.clips()) {
            size.frames += static_cast<double>(clip.frames);
            size.edges += static_cast<double>(clip.edges);
        }
    }
    return size;
}

double nanoseconds(double seconds, int64_t count) {
    return seconds * 1e9 / static_cast<double>(count);
}

/// A mixture on as many rows as --frames-per-cluster would give it, where there are as many.
ClusterRates measure_mixture(const MatrixF& all_rows, int64_t clusters, int turns) {
    constexpr int64_t frames_per_cluster = 25, least_rows = 8192;
    const int64_t count =
        std::min(all_rows.rows(), std::max(least_rows, clusters * frames_per_cluster));
    const MatrixF first_rows = all_rows.topRows(count);
    const MatrixRows rows(first_rows);
    const double floor = least_variance(moments_of(rows, 1), {});

    Least start, iteration, letters;
    Mixture model;
    for (int turn = 0; turn < turns; ++turn) {
        start.time([&] { model = start_mixture(rows, clusters, {}, 0, 1); });
    }
    constexpr int settling = 3;  // the first iterations meet equal variances, which rule out less
    double settled = 0;
    for (int turn = 0; turn < settling + turns; ++turn) {
        Least one;
        one.time([&] { model = estimate(model, accumulate(model, rows, 1), floor); });
        if (turn < settling) {
            settled += one.cpu;
        } else {
            iteration.enter(one.wall, one.cpu);
        }
    }
    const double more = std::max(0.0, settled - settling * iteration.cpu);
    for (int turn = 0; turn < turns; ++turn) {
        letters.time([&] { likeliest_clusters(model, rows, 1); });
    }
    return {.clusters = static_cast<double>(model.clusters()),
            .start_nanoseconds_per_row = nanoseconds(start.cpu + more, count),
            .iteration_nanoseconds_per_row = nanoseconds(iteration.cpu, count),
            .letter_nanoseconds_per_row = nanoseconds(letters.cpu, count)};
}

/// More clusters never cost less, though the clock may say so where they take next to no time.
ClusterRates no_less(ClusterRates rates, const ClusterRates& fewer) {
    for (const auto part :
         {&ClusterRates::start_nanoseconds_per_row, &ClusterRates::iteration_nanoseconds_per_row,
          &ClusterRates::letter_nanoseconds_per_row}) {
        rates.*part = std::max(rates.*part, fewer.*part);
    }
    return rates;
}

double measure_serial_share(const MatrixRows& rows, int turns, int threads) {
    constexpr int64_t clusters = 1000;
    const Mixture model = start_mixture(rows, clusters, {}, 0, threads);
    Least one, all;
    for (int turn = 0; turn < turns; ++turn) {
        one.time([&] { accumulate(model, rows, 1); });
        all.time([&] { accumulate(model, rows, threads); });
    }
    return serial_share(one.wall, all.wall, threads);
}

double measure_accessibility(const MatrixRows& rows, int turns) {
    constexpr int64_t letters = 2000;
    const Mixture model = start_mixture(rows, std::min(letters, rows.rows()), {}, 0, 1);
    Least least;
    for (int turn = 0; turn < turns; ++turn) least.time([&] { accessibility(model, 1.0, 1); });
    return nanoseconds(least.cpu, model.clusters() * model.clusters());
}

/// To index so many rows of a graph's width that move on a little from one to the next.
double measure_index(double count, int turns) {
    constexpr int64_t columns = 45;
    RandomStream random(1, "rows to index");
    MatrixF rows = MatrixF::Zero(static_cast<int64_t>(count), columns);
    for (int64_t i = 1; i < rows.rows(); ++i) {
        for (int64_t j = 0; j < columns; ++j) {
            rows(i, j) = rows(i - 1, j) + static_cast<float>(random.uniform() - 0.5);
        }
    }
    Least least;
    for (int turn = 0; turn < turns; ++turn) {
        least.time([&] { KnnIndex(rows, KnnEngine::blocks, 1); });
    }
    return nanoseconds(least.cpu, rows.rows());
}

/// Poses, each as often as there are levels in a balanced tree of the leaves found.
double poses_by_levels(const Generation& generation) {
    const ArtifactReader file = generation.open("pose_hierarchy.h5");
    double values = 0;
    for (const std::string& clip_class : hierarchy_classes(file)) {
        const PoseHierarchy hierarchy = read_pose_hierarchy(file, "/" + clip_class).hierarchy;
        values += static_cast<double>(hierarchy.nodes.front().rows) *
                  (1 + std::log2(static_cast<double>(hierarchy.leaves())));
    }
    return values;
}

std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    }
    return "unknown";
}

enum StageNumber : size_t {
    frames_stage,
    features_stage,
    pose_clusters_stage,
    strings_stage,
    pose_hierarchy_stage,
    bundles_stage,
    bundle_graph_stage,
    signatures_stage,
    neighbors_stage,
    segments_stage,
    primitives_stage,
    corpus_neighbors_stage
};

Rates measure(const Options& options) {
    const Resources resources = granted_resources(options.threads, std::nullopt);
    const TemporaryFolder folder;
    generate_corpus({.frames = options.frames}, folder / "takes", resources.threads);
    generate_corpus({.frames = 100, .subjects = 1}, folder / "take", resources.threads);

    StageTimes one, all, empty, bundles_of_one, bundles_of_all;
    const int threads = resources.threads;
    for (int turn = 0; turn < options.turns; ++turn) {
        const fs::path store = folder / "store", takes = folder / "takes";
        time_stages(request_of_bundles(takes, store, resources, 1), bundles_of_one);
        time_stages(request_of_bundles(takes, store, resources, threads), bundles_of_all);
        time_stages(request(folder / "take", store, resources, 1), empty);
        time_stages(request(takes, store, resources, threads), all);
        time_stages(request(takes, store, resources, 1), one);
    }
    for (const StageNumber stage : {bundles_stage, bundle_graph_stage}) {
        one[stage] = bundles_of_one[stage];
        all[stage] = bundles_of_all[stage];
    }
    const OpenStore opened(folder / "store");
    const int64_t count = opened.generation.catalog().frames();
    const auto files = static_cast<double>(opened.generation.ledger().of_stage("frames").size());

    const auto shard_rates = [&](StageNumber stage, double values, double elsewhere = 0) {
        ShardRates rates;
        rates.seconds_per_file = empty[stage].wall;
        rates.nanoseconds_per_value =
            std::max(0.0, one[stage].cpu - files * empty[stage].cpu - elsewhere) * 1e9 / values;
        rates.serial_share = serial_share(one[stage].wall, all[stage].wall, threads);
        return rates;
    };
    const ClassShape shape;  // of the generated corpus too
    Rates rates;
    rates.machine = processor();
    rates.version = opened.generation.ledger().version;
    rates.threads = threads;
    const FeatureOptions features;
    const auto frames = static_cast<double>(count);
    rates.frames = shard_rates(frames_stage, frames * values_of_frames(shape));
    rates.features =
        shard_rates(features_stage, frames * values_of_features(shape, features, 120.0));
    rates.pose_hierarchy = shard_rates(pose_hierarchy_stage, poses_by_levels(opened.generation));
    rates.signatures = shard_rates(signatures_stage, frames);
    rates.neighbors =
        shard_rates(neighbors_stage, 2 * size_of_graphs(opened.generation, "neighbors").edges);
    const GraphSize searched = size_of_graphs(opened.generation, "corpus_neighbors");
    rates.search.nanoseconds_per_row = measure_index(searched.frames, options.turns);
    rates.corpus_neighbors =
        shard_rates(corpus_neighbors_stage, 3 * searched.edges * crowding(searched.frames),
                    files * searched.frames * rates.search.nanoseconds_per_row * 1e-9);
    rates.bundles = shard_rates(bundles_stage, frames);  // generated at the pose rate
    rates.bundle_graph = shard_rates(bundle_graph_stage, frames);
    const double graph_frames = frames * features.effector_rate / 120.0;
    rates.segments = shard_rates(segments_stage, graph_frames);
    rates.primitives = shard_rates(primitives_stage, graph_frames);

    const auto per_row = [&](StageNumber stage) {
        return nanoseconds(std::max(0.0, one[stage].cpu - empty[stage].cpu), count);
    };
    const MatrixF rows = projected_rows(folder / "store");
    PoseRates& poses = rates.poses;
    poses.seconds_per_file = empty[pose_clusters_stage].wall;
    poses.projection_nanoseconds_per_row = per_row(strings_stage);
    poses.moments_nanoseconds_per_row =
        std::max(0.0, per_row(pose_clusters_stage) - poses.projection_nanoseconds_per_row);
    poses.accessibility_nanoseconds_per_pair =
        measure_accessibility(MatrixRows(rows), options.turns);
    poses.serial_share = measure_serial_share(MatrixRows(rows), options.turns, threads);
    for (const int64_t clusters : {30, 100, 300, 1000, 3000, 8000}) {
        if (clusters > rows.rows()) break;
        const ClusterRates measured = measure_mixture(rows, clusters, options.turns);
        const ClusterRates& fewer = poses.by_clusters.empty() ? measured : poses.by_clusters.back();
        poses.by_clusters.push_back(no_less(measured, fewer));
    }
    return rates;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    bench::Program program("How fast does this machine work? For `kinetome plan --rates`");
    program.option("-o,--output", options.output, "file to write (default: standard output)");
    program.count("--frames", options.frames, "of the generated corpus");
    program.count("--turns", options.turns, "of each measurement, of which the least counts");
    program.option("--threads", options.threads, "that are \"all\" (default: what was granted)");
    return program.run(argc, argv, [&] {
        if (options.frames < least_frames)
            throw UsageError(fmt::format("--frames {}: at least {}", options.frames, least_frames));
        const std::string text = write_rates(measure(options));
        if (options.output.empty()) {
            std::fputs(text.c_str(), stdout);
        } else {
            write_file_atomically(options.output, text);
        }
        return true;
    });
}
