// How fast is one EM iteration, what does a second thread bring, and which numbers come out?
//   mixture_bench                    seconds and evaluations a second of each iteration
//   mixture_bench --scaling          one thread against two, run in turns
//   mixture_bench --json             one line for mixture_peer.py, which compares with scikit-learn
// An evaluation is the density of one cluster at one frame.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "cost.h"
#include "kinetome/base/random.h"
#include "kinetome/base/resources.h"
#include "kinetome/math/mixture.h"
#include "program.h"

namespace {

using namespace kinetome;
using namespace kinetome::bench;
namespace fs = std::filesystem;

struct Options {
    int64_t frames = 106'000;
    int64_t dimension = 15;
    int64_t clusters = 1000;
    int threads = 1;
    int iterations = 5;
    int repetitions = 9;
    bool scaling = false;
    bool json = false;
    fs::path rows;  ///< float32, frames × dimension; generated when empty
    fs::path dump;  ///< directory to write rows and start to
};

/// A few harmonics of one cycle in every dimension, weaker in the later ones, as principal
/// components are.
struct Activity {
    static constexpr int harmonics = 3;
    std::vector<double> amplitude, phase, place;

    Activity(int64_t dimension, RandomStream& random) {
        for (int64_t j = 0; j < dimension; ++j) {
            const double strength = 3 / std::sqrt(1.0 + static_cast<double>(j));
            place.push_back(strength * random.normal());
            for (int h = 1; h <= harmonics; ++h) {
                amplitude.push_back(strength * random.normal() / (2 * h));
                phase.push_back(random.uniform(0, 2 * std::numbers::pi));
            }
        }
    }
    double at(int64_t j, double cycles) const {
        double value = place[static_cast<size_t>(j)];
        for (int h = 1; h <= harmonics; ++h) {
            const auto term = static_cast<size_t>(j * harmonics + h - 1);
            value += amplitude[term] * std::sin(2 * std::numbers::pi * h * cycles + phase[term]);
        }
        return value;
    }
};

/// Clips at 120 frames a second, each one of 40 activities in a manner of its own.
MatrixF pose_like_rows(int64_t frames, int64_t dimension) {
    constexpr int64_t clip_frames = 1500, activity_count = 40;
    RandomStream random(1, "pose-like rows");
    std::vector<Activity> activities;
    for (int64_t a = 0; a < activity_count; ++a) activities.emplace_back(dimension, random);
    MatrixF rows(frames, dimension);
    for (int64_t first = 0; first < frames; first += clip_frames) {
        const Activity& activity = activities[random.below(activity_count)];
        const double rate = random.uniform(0.4, 1.2) / 120, strength = random.uniform(0.8, 1.2);
        std::vector<double> style(static_cast<size_t>(dimension));
        for (double& offset : style) offset = 0.2 * random.normal();
        for (int64_t i = first; i < std::min(first + clip_frames, frames); ++i) {
            for (int64_t j = 0; j < dimension; ++j) {
                double& offset = style[static_cast<size_t>(j)];
                offset = 0.999 * offset + 0.01 * random.normal();
                const double value = activity.at(j, rate * static_cast<double>(i - first));
                rows(i, j) = static_cast<float>(strength * value + offset);
            }
        }
    }
    return rows;
}

MatrixF read_rows(const Options& options) {
    MatrixF rows(options.frames, options.dimension);
    const auto bytes = static_cast<std::streamsize>(sizeof(float)) * rows.size();
    std::ifstream file(options.rows, std::ios::binary);
    if (!file.read(reinterpret_cast<char*>(rows.data()), bytes)) {
        throw std::runtime_error(options.rows.string() + ": fewer values than were asked for");
    }
    return rows;
}

template <class Matrix>
void write_values(const fs::path& path, const Matrix& values) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(sizeof(typename Matrix::Scalar)) * values.size());
    if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

/// The rows, their start, and what an iteration does, without the end of a fit.
struct Workload {
    explicit Workload(const Options& options)
        : rows(options.rows.empty() ? pose_like_rows(options.frames, options.dimension)
                                    : read_rows(options)),
          layout(layout_rows(rows.rows())) {
        start_cost = cost_of([&] {
            start =
                start_mixture(MatrixRows(rows, layout), options.clusters, {}, 0, options.threads);
        });
    }
    /// No floor but that of rounding: scikit-learn has another one.
    double floor() const {
        MixtureOptions options;
        options.variance_floor = 0;
        return least_variance(moments_of(MatrixRows(rows, layout), 1), options);
    }

    MatrixF rows;
    PieceLayout layout;
    Mixture start;
    Cost start_cost;
};

void print_iterations(const Workload& work, const Options& options) {
    const double floor = work.floor();
    Mixture model = work.start;
    std::printf("start      %8.4f s wall %8.4f s CPU\n", work.start_cost.wall, work.start_cost.cpu);
    for (int i = 0; i < options.iterations; ++i) {
        MixtureSums sums;
        const Cost cost = cost_of([&] {
            sums = accumulate(model, MatrixRows(work.rows, work.layout), options.threads);
            model = estimate(model, sums, floor);
        });
        const double evaluations =
            static_cast<double>(work.rows.rows()) * static_cast<double>(model.clusters());
        std::printf(
            "iteration %d %8.4f s wall %8.4f s CPU %6.2f G evaluations/s a CPU second, "
            "mean log-likelihood %.9f\n",
            i + 1, cost.wall, cost.cpu, evaluations / cost.cpu / 1e9, sums.mean_log_likelihood());
    }
}

void print_json(const Workload& work, const Options& options) {
    const double floor = work.floor();
    std::vector<double> walls, cpus, likelihoods;
    Mixture model = work.start;
    for (int i = 0; i < options.iterations; ++i) {
        const Cost cost = cost_of([&] {
            const MixtureSums sums =
                accumulate(model, MatrixRows(work.rows, work.layout), options.threads);
            model = estimate(model, sums, floor);
            likelihoods.push_back(sums.mean_log_likelihood());
        });
        walls.push_back(cost.wall);
        cpus.push_back(cost.cpu);
    }
    const nlohmann::json line = {{"wall", median(walls)},
                                 {"cpu", median(cpus)},
                                 {"clusters", model.clusters()},
                                 {"log_likelihoods", likelihoods}};
    std::cout << line.dump() << '\n';
}

void print_scaling(const Workload& work, const Options& options) {
    std::vector<double> one, two, ratios;
    Mixture model = work.start;
    for (int i = 0; i < options.repetitions; ++i) {
        const auto wall = [&](int threads) {
            return cost_of([&] { accumulate(model, MatrixRows(work.rows, work.layout), threads); })
                .wall;
        };
        one.push_back(wall(1));
        two.push_back(wall(2));
        ratios.push_back(one.back() / two.back());
        if (i == 0)
            model = estimate(model, accumulate(model, MatrixRows(work.rows, work.layout), 2), 1e-6);
    }
    const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
    std::printf("1 thread %.4f s, 2 threads %.4f s (medians of %d): %.2f times (%.2f to %.2f)\n",
                median(one), median(two), options.repetitions, median(ratios), *least, *most);
}

void run(const Options& options) {
    const Workload work(options);
    if (!options.dump.empty()) {
        write_values(options.dump / "rows.f32", work.rows);
        write_values(options.dump / "means.f64", work.start.means);
        write_values(options.dump / "variances.f64", work.start.variances);
    } else if (options.scaling) {
        print_scaling(work, options);
    } else if (options.json) {
        print_json(work, options);
    } else {
        print_iterations(work, options);
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    bench::Program program("EM for isotropic mixtures: time and likelihood of each iteration");
    program.count("--frames", options.frames, "rows to generate or to read");
    program.count("--dimension", options.dimension, "columns");
    program.count("--clusters", options.clusters, "clusters");
    program.count("--threads", options.threads, "threads");
    program.count("--iterations", options.iterations, "iterations");
    program.count("--repetitions", options.repetitions, "turns of --scaling");
    program.option("--rows", options.rows, "raw float32 rows to use instead of generated ones");
    program.option("--dump", options.dump, "write rows and start to this directory and stop");
    program.flag("--scaling", options.scaling, "one thread against two");
    program.flag("--json", options.json, "one line for mixture_peer.py");
    return program.run(argc, argv, [&] {
        run(options);
        return true;
    });
}
