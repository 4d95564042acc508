// How fast are the nearest frames found, against FLANN, nanoflann and a plain scan by products?
//
//   knn_bench CORPUS [--queries N] [--turns N] [--threads N] [--radius CM…] [--neighbours K]
//       CORPUS: a folder with NN/NN.asf and NN/NN_*.amc
//       --queries     frames that are asked for, in runs of 64 (default: 2048)
//       --leaf        rows in a leaf of FLANN's and nanoflann's tree (default: 10, as theirs)
//
// Frames are end effectors stacked with those 1/30 s before and after (45 columns), at 120 and at
// 30 Hz. All engines answer the same queries, in turns. Ends with 1 when FLANN's distances differ
// from ours by more than 1e-5, or its rows below the last.
#include <fmt/format.h>
#include <time.h>

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cost.h"
#include "kinetome/base/parallel.h"
#include "kinetome/base/resources.h"
#include "kinetome/math/knn.h"
#include "knn_lists.h"
#ifdef KINETOME_WITH_NANOFLANN
#include "nanoflann_search.h"
#endif
#include "program.h"
#include "takes.h"

namespace {

using namespace kinetome;
using namespace kinetome::bench;
namespace fs = std::filesystem;

struct Options {
    fs::path corpus;
    int64_t queries = 2048;
    int turns = 5;
    int threads = 1;
    int leaf = 10;
    std::vector<double> radii = {64, 72};  ///< cm: the paper's and ours
    int64_t neighbours = 128;
};

/// What one comparison asks for.
struct Question {
    KnnOptions knn;
    int leaf = 10;
    float squared_radius() const { return static_cast<float>(knn.radius * knn.radius); }
};

MatrixF corpus_rows(const fs::path& folder, double rate, int threads) {
    std::vector<fs::path> files = bench::amc_files(folder);
    std::ranges::sort(files);
    std::vector<MatrixF> takes(files.size());
    parallel_for(threads, static_cast<int64_t>(files.size()), [&](int64_t i) {
        takes[size_t(i)] = bench::stacked_effectors(bench::read_take(files[size_t(i)]), rate);
    });
    int64_t count = 0;
    for (const MatrixF& take : takes) count += take.rows();
    MatrixF rows(count, takes.front().cols());
    count = 0;
    for (const MatrixF& take : takes) {
        rows.middleRows(count, take.rows()) = take;
        count += take.rows();
    }
    return rows;
}

/// Runs of consecutive frames, evenly spaced.
MatrixF sample(const MatrixF& rows, int64_t count) {
    constexpr int64_t run = 64;
    const int64_t runs = std::max<int64_t>(1, std::min(count, rows.rows()) / run);
    MatrixF queries(std::min(runs * run, rows.rows()), rows.cols());
    for (int64_t i = 0; i < queries.rows(); i += run) {
        const int64_t size = std::min(run, queries.rows() - i);
        queries.middleRows(i, size) = rows.middleRows(i / run * (rows.rows() / runs), size);
    }
    return queries;
}

class Flann {
  public:
    Flann(const MatrixF& rows, const Question& question)
        : question_(question),
          tree_(as_flann(rows), flann::KDTreeSingleIndexParams(question.leaf)) {
        tree_.buildIndex();
    }
    Lists search(const MatrixF& queries, int cores) {
        flann::SearchParams parameters(flann::FLANN_CHECKS_UNLIMITED, 0, true);
        parameters.max_neighbors = static_cast<int>(question_.knn.neighbours);
        parameters.cores = cores;
        std::vector<std::vector<size_t>> rows;
        std::vector<std::vector<float>> squared;
        tree_.radiusSearch(as_flann(queries), rows, squared, question_.squared_radius(),
                           parameters);
        Lists lists(rows.size());
        for (size_t q = 0; q < rows.size(); ++q)
            for (size_t i = 0; i < rows[q].size(); ++i)
                lists[q].emplace_back(squared[q][i], rows[q][i]);
        return lists;
    }

  private:
    static flann::Matrix<float> as_flann(const MatrixF& rows) {
        return {const_cast<float*>(rows.data()), size_t(rows.rows()), size_t(rows.cols())};
    }
    const Question& question_;
    flann::KDTreeSingleIndex<flann::L2<float>> tree_;
};

/// All squared distances as |a|² + |b|² - 2ab, by Eigen's matrix product.
class ProductScan {
  public:
    ProductScan(const MatrixF& rows, const Question& question)
        : question_(question),
          centre_(rows.colwise().mean()),
          rows_(rows.rowwise() - centre_),
          squares_(rows_.rowwise().squaredNorm()) {}

    Lists search(const MatrixF& queries, int threads) const {
        constexpr int64_t queries_at_once = 64;
        Lists lists(size_t(queries.rows()));
        parallel_for(threads, (queries.rows() + queries_at_once - 1) / queries_at_once,
                     [&](int64_t part) {
                         const int64_t first = part * queries_at_once;
                         const int64_t count = std::min(queries_at_once, queries.rows() - first);
                         scan(queries.middleRows(first, count).rowwise() - centre_, first, lists);
                     });
        return lists;
    }

  private:
    void scan(const MatrixF& queries, int64_t first_query, Lists& lists) const {
        constexpr int64_t rows_at_once = 1024;
        const VectorF squares = queries.rowwise().squaredNorm();
        std::vector<float> limits(size_t(queries.rows()), question_.squared_radius());
        MatrixF products;
        for (int64_t first = 0; first < rows_.rows(); first += rows_at_once) {
            const int64_t count = std::min(rows_at_once, rows_.rows() - first);
            products.noalias() = -2 * queries * rows_.middleRows(first, count).transpose();
            products.rowwise() += squares_.segment(first, count).transpose();
            for (int64_t q = 0; q < queries.rows(); ++q) {
                auto& list = lists[size_t(first_query + q)];
                for (int64_t i = 0; i < count; ++i) {
                    const float squared = products(q, i) + squares[q];
                    if (squared <= limits[size_t(q)]) list.emplace_back(squared, first + i);
                }
                limits[size_t(q)] = keep_nearest(list, limits[size_t(q)]);
            }
        }
        for (int64_t q = 0; q < queries.rows(); ++q)
            std::sort(lists[size_t(first_query + q)].begin(), lists[size_t(first_query + q)].end());
    }
    float keep_nearest(std::vector<std::pair<float, size_t>>& list, float limit) const {
        const auto most = static_cast<size_t>(question_.knn.neighbours);
        if (list.size() <= most) return limit;
        std::nth_element(list.begin(), list.begin() + int64_t(most) - 1, list.end());
        list.resize(most);
        return list.back().first;
    }

    const Question& question_;
    Eigen::RowVectorXf centre_;
    MatrixF rows_;
    VectorF squares_;
};

struct Engine {
    Engine(std::string engine_name, std::function<void()> to_build, std::function<void()> to_search)
        : name(std::move(engine_name)), build(std::move(to_build)), search(std::move(to_search)) {}

    std::string name;
    std::function<void()> build, search;
    Cost built{};
    std::vector<double> wall{}, cpu{};
};

void print_table(const std::vector<Engine>& engines, int64_t queries) {
    fmt::print("{:<22} {:>9} {:>15} {:>15} {:>22}\n", "", "build s", "CPU µs a query",
               "wall µs a query", "CPU, times ours");
    const double ours = median(engines.front().cpu);
    for (const Engine& engine : engines) {
        std::vector<double> ratios;
        for (size_t i = 0; i < engine.cpu.size(); ++i)
            ratios.push_back(engine.cpu[i] / engines.front().cpu[i]);
        const auto [least, most] = std::ranges::minmax(ratios);
        const double scale = 1e6 / static_cast<double>(queries);
        fmt::print("{:<22} {:>9.2f} {:>15.1f} {:>15.1f} {:>8.1f} ({:.1f} to {:.1f})\n", engine.name,
                   engine.built.cpu, median(engine.cpu) * scale, median(engine.wall) * scale,
                   median(engine.cpu) / ours, least, most);
    }
}

/// Whether the distances agree to 1e-5, and the rows below the last.
bool agree(const NeighbourLists& ours, const Lists& theirs, const MatrixF& rows,
           const MatrixF& queries) {
    double worst = 0;
    int64_t other_rows = 0, other_lengths = 0;
    for (size_t q = 0; q < theirs.size(); ++q) {
        const auto distances = ours.distances_of(int64_t(q));
        const auto our_rows = ours.rows_of(int64_t(q));
        if (distances.size() != theirs[q].size()) {
            ++other_lengths;
            continue;
        }
        if (distances.empty()) continue;
        const double below = double(distances.back()) * (1 - 1e-5);
        std::vector<size_t> found, expected;
        for (size_t i = 0; i < distances.size(); ++i) {
            const auto [squared, row] = theirs[q][i];
            const double distance = std::sqrt(double(squared));
            worst = std::max(
                worst, std::abs(distance - double(distances[i])) / (1 + double(distances[i])));
            if (double(distances[i]) < below) expected.push_back(size_t(our_rows[i]));
            const double exact =
                (rows.row(int64_t(row)).cast<double>() - queries.row(int64_t(q)).cast<double>())
                    .norm();
            if (exact < below) found.push_back(row);
        }
        std::ranges::sort(found);
        std::ranges::sort(expected);
        other_rows += found != expected;
    }
    fmt::print(
        "FLANN against ours: distances differ by {:.1e} at most, {} lists of other rows "
        "below the last, {} of other length\n",
        worst, other_rows, other_lengths);
    return worst <= 1e-5 && other_rows == 0 && other_lengths == 0;
}

/// However busy the machine is: the share of a search's CPU time that this thread did not spend.
void print_cores(Flann& flann, const MatrixF& queries, int threads) {
    const auto own_seconds = [] {
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    };
    for (const int cores : {1, threads}) {
        const double own_started = own_seconds();
        const Cost cost = cost_of([&] { flann.search(queries, cores); });
        const double own = own_seconds() - own_started;
        fmt::print("FLANN, cores = {}: {:.0f} % of its CPU time in other threads\n", cores,
                   100 * std::max(0.0, 1 - own / cost.cpu));
    }
}

/// FLANN's CPU time as a multiple of ours.
struct Ratio {
    double rate = 0;
    double radius = 0;
    double times = 0;
};

/// False when FLANN found something else.
bool compare(const Options& options, double radius, double rate, const MatrixF& rows,
             std::vector<Ratio>& ratios) {
    const Question question{{radius, options.neighbours}, options.leaf};
    const MatrixF queries = sample(rows, options.queries);
    const int threads = options.threads;
    std::unique_ptr<KnnIndex> blocks;
    std::unique_ptr<Flann> flann;
    std::unique_ptr<ProductScan> scan;
    NeighbourLists ours;
    Lists theirs, others;
    std::vector<Engine> engines;
    engines.emplace_back(
        "blocks", [&] { blocks = std::make_unique<KnnIndex>(rows, KnnEngine::blocks, threads); },
        [&] { ours = blocks->search(queries, question.knn, threads); });
    engines.emplace_back(
        "FLANN", [&] { flann = std::make_unique<Flann>(rows, question); },
        [&] { theirs = flann->search(queries, threads); });
#ifdef KINETOME_WITH_NANOFLANN
    std::unique_ptr<NanoflannSearch> nanoflann;
    engines.emplace_back(
        "nanoflann",
        [&] { nanoflann = std::make_unique<NanoflannSearch>(rows, question.knn, question.leaf); },
        [&] { others = nanoflann->search(queries, threads); });
#endif
    engines.emplace_back(
        "scan by products", [&] { scan = std::make_unique<ProductScan>(rows, question); },
        [&] { others = scan->search(queries, threads); });
    fmt::print("\n{} frames at {} Hz, {} queries, radius {} cm, {} neighbours, {} threads\n",
               rows.rows(), rate, queries.rows(), radius, options.neighbours, threads);
    for (Engine& engine : engines) engine.built = cost_of(engine.build);
    for (int turn = 0; turn < options.turns; ++turn) {
        for (Engine& engine : engines) {
            const Cost cost = cost_of(engine.search);
            engine.wall.push_back(cost.wall);
            engine.cpu.push_back(cost.cpu);
        }
    }
    print_table(engines, queries.rows());
    ratios.push_back({rate, radius, median(engines[1].cpu) / median(engines[0].cpu)});
    const Cost all = cost_of([&] { blocks->search(rows, question.knn, threads); });
    fmt::print("blocks, every frame: {:.2f} s of CPU, {:.2f} s wall\n", all.cpu, all.wall);
    print_cores(*flann, queries, threads);
    return agree(ours, theirs, rows, queries);
}

bool compare_all(const Options& options) {
    bool agreed = true;
    std::vector<Ratio> ratios;
    for (const double rate : {120.0, 30.0}) {
        const MatrixF rows = corpus_rows(options.corpus, rate, options.threads);
        for (const double radius : options.radii) {
            agreed &= compare(options, radius, rate, rows, ratios);
        }
    }
    fmt::print("\nFLANN's CPU time, times ours, on {} threads each:\n", options.threads);
    for (const Ratio& one : ratios) {
        fmt::print("  {:>3} Hz, radius {} cm, {} neighbours: {:.1f}\n", one.rate, one.radius,
                   options.neighbours, one.times);
    }
    return agreed;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    bench::Program program("How fast are the nearest frames found?");
    program.argument("corpus", options.corpus, "folder with NN/NN.asf and NN/NN_*.amc");
    program.count("--queries", options.queries, "frames that are asked for");
    program.count("--turns", options.turns, "of each measurement");
    program.count("--threads", options.threads);
    program.count("--leaf", options.leaf, "rows in a leaf of the trees");
    program.option("--radius", options.radii, "cm, one or several");
    program.count("--neighbours", options.neighbours);
    return program.run(argc, argv, [&] { return compare_all(options); });
}
