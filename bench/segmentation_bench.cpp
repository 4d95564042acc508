// How well and how fast are takes segmented?
//
//   segmentation_bench CORPUS [TRUTH] [--method repetition|region-growing] [--turns N] [--threads
//   N]
//       CORPUS: a folder with NN/NN.asf and NN/NN_*.amc
//       TRUTH: CSV of its annotated activities (clip,first,end,label,end_lo,end_hi)
//
// Prints, of each annotated take, how its segments agree with the annotation and the milliseconds
// that each step takes on one thread (the median of the turns); the same times for 20 seconds of a
// movement without a break; and how long all takes last, threads sharing them.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "cost.h"
#include "kinetome/base/parallel.h"
#include "kinetome/models/activity.h"
#include "kinetome/models/primitive.h"
#include "kinetome/models/primitive_clusters.h"
#include "kinetome/models/segmentation_score.h"
#include "kinetome/synthesis/take.h"
#include "program.h"
#include "takes.h"

namespace {

using namespace kinetome;
namespace fs = std::filesystem;

struct Options {
    fs::path corpus, truth;
    std::string method = "repetition";
    int turns = 9;
    int threads = 2;
    ActivityOptions activities;
    PrimitiveOptions primitives;
};

/// Seconds.
struct StepTimes {
    double graph = 0, activities = 0, primitives = 0, clusters = 0;
    double sum() const { return graph + activities + primitives + clusters; }
};

struct Result {
    std::vector<Segment> segments;
    std::vector<Primitive> primitives;
    StepTimes seconds;
};

Result segment_once(const MatrixF& features, const Options& options) {
    Result result;
    NeighborGraph graph;
    const KnnOptions knn;  // wide enough for either method
    result.seconds.graph =
        bench::cost_of([&] { graph = neighbor_graph(features, knn, KnnEngine::blocks, 1); }).wall;
    result.seconds.activities = bench::cost_of([&] {
                                    result.segments =
                                        find_activities(graph, features, options.activities);
                                }).wall;
    result.seconds.primitives = bench::cost_of([&] {
                                    result.primitives = find_primitives(
                                        features, graph, result.segments, options.primitives);
                                }).wall;
    std::vector<CorpusPrimitive> primitives;
    for (const Primitive& primitive : result.primitives) {
        primitives.push_back({0, primitive.frames});
    }
    result.seconds.clusters =
        bench::cost_of([&] { cluster_primitives(features, primitives, {}, 1); }).wall;
    return result;
}

Result segment(const MatrixF& features, const Options& options) {
    Result result;
    std::vector<StepTimes> turns;
    for (int turn = 0; turn < options.turns; ++turn) {
        result = segment_once(features, options);
        turns.push_back(result.seconds);
    }
    const auto median_of = [&](double StepTimes::*step) {
        std::vector<double> seconds;
        for (const StepTimes& turn : turns) seconds.push_back(turn.*step);
        return bench::median(std::move(seconds));
    };
    result.seconds = {median_of(&StepTimes::graph), median_of(&StepTimes::activities),
                      median_of(&StepTimes::primitives), median_of(&StepTimes::clusters)};
    return result;
}

std::vector<Segment> at_rate_of(std::vector<Segment> segments, int64_t factor, int64_t frames) {
    for (Segment& segment : segments) {
        segment.frames.first *= factor;
        segment.frames.end = std::min(segment.frames.end * factor, frames);
    }
    return segments;
}

void print_times(const std::string& name, int64_t frames, const StepTimes& seconds) {
    fmt::print("{:<16} {:>6} {:>8.1f} {:>10.1f} {:>10.1f} {:>8.1f} {:>8.1f}", name, frames,
               1e3 * seconds.graph, 1e3 * seconds.activities, 1e3 * seconds.primitives,
               1e3 * seconds.clusters, 1e3 * seconds.sum());
}

void print_score(const SegmentationScore& score, size_t primitives) {
    fmt::print("   {:.3f}  {:.3f}  {:.3f}  {:.3f}  {:.3f}  {:>3}/{:<3} {:>3}\n", score.strict,
               score.tolerant, score.hungarian_without_zones, score.boundary_precision,
               score.boundary_recall, score.counts.activities, score.counts.true_activities,
               primitives);
}

/// The rows of each clip, in the order of the file.
std::vector<std::vector<TruthRow>> annotated_takes(const fs::path& truth) {
    std::vector<std::vector<TruthRow>> takes;
    for (TruthRow& row : parse_truth_csv(read_source_file(truth), truth.string())) {
        if (takes.empty() || takes.back().front().clip != row.clip) takes.emplace_back();
        takes.back().push_back(std::move(row));
    }
    return takes;
}

void judge_annotated_takes(const Options& options) {
    std::vector<SegmentationScore> scores;
    for (const std::vector<TruthRow>& rows : annotated_takes(options.truth)) {
        const std::string& name = rows.front().clip;
        const std::string subject = name.substr(0, name.find('_'));
        const Clip take = bench::read_take(options.corpus / subject / (name + ".amc"));
        const MatrixF features = bench::stacked_effectors(take, options.activities.rate);
        const Result result = segment(features, options);
        const auto truth = truth_timeline(rows, take.frames(), take.rate, options.truth.string());
        const auto factor = std::llround(take.rate / options.activities.rate);
        scores.push_back(score_segments(truth, at_rate_of(result.segments, factor, take.frames()),
                                        {.rate = take.rate}));
        print_times(name, features.rows(), result.seconds);
        print_score(scores.back(), result.primitives.size());
    }
    fmt::print("{:<71}", "mean");
    print_score(average(scores), 0);
}

/// Of a generated take in which one movement repeats from the first frame to the last.
MatrixF unbroken_movement(double seconds, double rate) {
    const auto frames = std::llround(seconds * synthesis_rate);
    for (int64_t index = 0;; ++index) {
        const TakePlan plan = plan_take(index, frames, 1, 1, 1);
        if (plan.segments.size() > 1 || !is_cyclic(plan.segments.front().activity)) continue;
        return bench::stacked_effectors(perform(plan, make_subject(1, 1), 1), rate);
    }
}

void segment_corpus(const Options& options) {
    const std::vector<fs::path> files = bench::amc_files(options.corpus);
    std::vector<MatrixF> takes(files.size());
    parallel_for(options.threads, int64_t(files.size()), [&](int64_t i) {
        const Clip take = bench::read_take(files[size_t(i)]);
        takes[size_t(i)] = bench::stacked_effectors(take, options.activities.rate);
    });
    int64_t frames = 0;
    for (const MatrixF& take : takes) frames += take.rows();
    const auto cost = bench::cost_of([&] {
        parallel_for(options.threads, int64_t(takes.size()),
                     [&](int64_t i) { segment_once(takes[size_t(i)], options); });
    });
    fmt::print("{} takes, {} frames, {} threads: {:.2f} s (processor: {:.2f} s)\n", takes.size(),
               frames, options.threads, cost.wall, cost.cpu);
}

void run(const Options& options) {
    fmt::print("{:<16} {:>6} {:>8} {:>10} {:>10} {:>8} {:>8}   {:<6} {:<6} {:<6} {:<6} {:<6} {}\n",
               "take", "frames", "graph", "activities", "primitives", "clusters", "sum, ms",
               "strict", "toler.", "hung.", "b prec", "b rec", "activ. primitives");
    if (!options.truth.empty()) judge_annotated_takes(options);
    const MatrixF unbroken = unbroken_movement(20, options.activities.rate);
    print_times("20 s unbroken", unbroken.rows(), segment(unbroken, options).seconds);
    fmt::print("\n");
    segment_corpus(options);
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    bench::Program program("How well and how fast are takes segmented?");
    program.argument("corpus", options.corpus, "folder with NN/NN.asf and NN/NN_*.amc");
    program.argument("truth", options.truth, "CSV of its annotated activities",
                     bench::Program::Need::optional);
    program.choice("--method", options.method, {"repetition", "region-growing"},
                   "of finding activities and primitives");
    program.count("--turns", options.turns, "of each measurement");
    program.count("--threads", options.threads, "for the whole corpus");
    return program.run(argc, argv, [&] {
        if (options.method == "region-growing") {
            options.activities.method = ActivityMethod::region_growing;
            options.primitives.method = PrimitiveMethod::warping_paths;
        }
        run(options);
        return true;
    });
}
