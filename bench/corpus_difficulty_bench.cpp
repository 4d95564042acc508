// Is a generated corpus as hard as real motion? Three figures for two corpora side by side, on
// equal numbers of frames, and their ratios; ends with 1 unless every ratio lies within 2 x.
//
//   corpus_difficulty_bench CORPUS REFERENCE [--frames N] [--letter-frames N]
//       CORPUS, REFERENCE: folders with NN/NN.asf and NN/NN_*.amc
//       --frames           frames of each that are looked at (default: all of the smaller one)
//       --letter-frames    of these, frames that pose clusters are fitted to (default: 60000)
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "kinetome/base/digest.h"
#include "kinetome/base/parallel.h"
#include "kinetome/base/pieces.h"
#include "kinetome/features/pose_vector.h"
#include "kinetome/math/moments.h"
#include "kinetome/math/pca.h"
#include "kinetome/models/motion_string.h"
#include "kinetome/models/pose_clusters.h"
#include "takes.h"

namespace {

using namespace kinetome;
namespace fs = std::filesystem;

struct Take {
    std::string name;
    std::string subject;
    MatrixF poses;    ///< frames x 62, at 120 Hz
    MatrixF stacked;  ///< frames x 45, at 30 Hz
    int64_t frames() const { return poses.rows(); }
};

struct Corpus {
    std::vector<Take> takes;
    VectorD floor;  ///< least scale of each pose feature

    int64_t frames() const {
        int64_t sum = 0;
        for (const Take& take : takes) sum += take.frames();
        return sum;
    }
};

constexpr double analysis_rate = 30;

/// Takes in the order of their names' hashes: any first part of them is a fair sample.
Corpus read_corpus(const fs::path& folder, int threads) {
    std::vector<fs::path> files = bench::amc_files(folder);
    const auto order = [](const fs::path& file) {
        return std::pair(hash_name(file.stem().string()), file.string());
    };
    std::ranges::sort(files, {}, order);

    Corpus corpus;
    corpus.takes.resize(files.size());
    std::vector<VectorD> floors(files.size());
    parallel_for(threads, static_cast<int64_t>(files.size()), [&](int64_t i) {
        const fs::path& file = files[static_cast<size_t>(i)];
        const Clip clip = bench::read_take(file);
        Take& take = corpus.takes[static_cast<size_t>(i)];
        take.name = file.stem().string();
        take.subject = file.parent_path().filename().string();
        take.poses = pose_vectors(*clip.skeleton, clip.motion, clip.rate);
        take.stacked = bench::stacked_effectors(clip, analysis_rate);
        VectorD& floor = floors[static_cast<size_t>(i)];
        const std::vector<PoseVectorColumn> columns = pose_vector_columns(*clip.skeleton);
        floor.resize(static_cast<Eigen::Index>(columns.size()));
        for (size_t c = 0; c < columns.size(); ++c)
            floor[static_cast<Eigen::Index>(c)] = columns[c].floor;
    });
    corpus.floor = floors.front();
    return corpus;
}

/// Keeps the first takes, the last one cut, so that `frames` are left.
void cut_to(Corpus& corpus, int64_t frames) {
    size_t kept = 0;
    for (; kept < corpus.takes.size() && frames > 0; ++kept) {
        Take& take = corpus.takes[kept];
        if (take.frames() > frames) {
            const auto rows = static_cast<double>(frames) * analysis_rate / 120;
            take.poses.conservativeResize(frames, Eigen::NoChange);
            take.stacked.conservativeResize(static_cast<int64_t>(std::ceil(rows)), Eigen::NoChange);
        }
        frames -= take.frames();
    }
    corpus.takes.resize(kept);
}

struct Rows {
    MatrixF poses;
    std::vector<int64_t> clip_frames;
    PieceLayout layout;
};

Rows gather(const Corpus& corpus, int64_t most_frames) {
    Rows rows;
    std::vector<ClipExtent> extents;
    int64_t total = 0;
    for (const Take& take : corpus.takes) {
        const int64_t frames = std::min(take.frames(), most_frames - total);
        if (frames == 0) break;
        rows.clip_frames.push_back(frames);
        extents.push_back({hash_name(take.name), frames, frames});
        total += frames;
    }
    rows.poses.resize(total, corpus.takes.front().poses.cols());
    int64_t first = 0;
    for (size_t i = 0; i < rows.clip_frames.size(); ++i) {
        const int64_t frames = rows.clip_frames[i];
        rows.poses.middleRows(first, frames) = corpus.takes[i].poses.topRows(frames);
        first += frames;
    }
    rows.layout = layout_pieces(extents);
    return rows;
}

Pca fit(const Rows& rows, const Corpus& corpus, int threads) {
    return fit_pca(moments_of(MatrixRows(rows.poses, rows.layout), threads), corpus.floor, 0.70);
}

double components_at_70_percent(const Corpus& corpus, int threads) {
    const Rows rows = gather(corpus, corpus.frames());
    return static_cast<double>(fit(rows, corpus, threads).dimension());
}

double frames_per_letter(const Corpus& corpus, int64_t frames, int threads) {
    const Rows rows = gather(corpus, frames);
    const MatrixF projected = fit(rows, corpus, threads).project(rows.poses);
    const PoseClusters clusters =
        fit_pose_clusters(MatrixRows(projected, rows.layout), {}, threads);
    const std::vector<int32_t> letters =
        likeliest_clusters(clusters.fit.model, MatrixRows(projected), threads);
    const MotionString string = make_motion_string(letters, rows.clip_frames);
    return static_cast<double>(rows.poses.rows()) / static_cast<double>(string.size());
}

double median(std::vector<double>& values) {
    if (values.empty()) throw InputError("too little motion to find neighbours in");
    const auto middle = values.begin() + static_cast<int64_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Distance, cm, from a frame to its 10th nearest in the same take that is more than a second away:
/// the median over all frames of takes of 5 to 30 s (the number of candidates matters).
double neighbour_distance(const Corpus& corpus, int threads) {
    constexpr int64_t second = 30;
    constexpr size_t rank = 10;
    std::vector<std::vector<double>> by_take(corpus.takes.size());
    parallel_for(threads, static_cast<int64_t>(corpus.takes.size()), [&](int64_t t) {
        const MatrixF& rows = corpus.takes[static_cast<size_t>(t)].stacked;
        if (rows.rows() < 5 * second || rows.rows() > 30 * second) return;
        std::vector<double> distances;
        for (int64_t i = 0; i < rows.rows(); ++i) {
            distances.clear();
            for (int64_t j = 0; j < rows.rows(); ++j) {
                if (std::abs(i - j) <= second) continue;
                distances.push_back(static_cast<double>((rows.row(i) - rows.row(j)).norm()));
            }
            if (distances.size() < rank) continue;
            std::nth_element(distances.begin(), distances.begin() + rank - 1, distances.end());
            by_take[static_cast<size_t>(t)].push_back(distances[rank - 1]);
        }
    });
    std::vector<double> all;
    for (const std::vector<double>& one : by_take) all.insert(all.end(), one.begin(), one.end());
    return median(all);
}

/// Prints a line of the table; whether the ratio is within 2 x.
bool compare(std::string_view figure, double value, double reference) {
    const double ratio = value / reference;
    const bool close = ratio >= 0.5 && ratio <= 2;
    fmt::print("{:<52} {:>10.2f} {:>10.2f} {:>7.2f}  {}\n", figure, value, reference, ratio,
               close ? "within 2 x" : "NOT WITHIN 2 x");
    std::fflush(stdout);
    return close;
}

int64_t option(const std::vector<std::string>& arguments, std::string_view name, int64_t fallback) {
    const auto found = std::ranges::find(arguments, name);
    if (found == arguments.end() || found + 1 == arguments.end()) return fallback;
    return std::strtoll((found + 1)->c_str(), nullptr, 10);
}

int run(const std::vector<std::string>& arguments) {
    if (arguments.size() < 2) {
        fmt::print(stderr,
                   "corpus_difficulty_bench CORPUS REFERENCE [--frames N] [--letter-frames N]\n");
        return 64;
    }
    const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    Corpus corpus = read_corpus(arguments[0], threads);
    Corpus reference = read_corpus(arguments[1], threads);
    const int64_t all = std::min(corpus.frames(), reference.frames());
    const int64_t frames = std::min(all, option(arguments, "--frames", all));
    const int64_t letter_frames = std::min(frames, option(arguments, "--letter-frames", 60'000));
    cut_to(corpus, frames);
    cut_to(reference, frames);

    fmt::print("{} frames of each, {} of them for letters\n", frames, letter_frames);
    fmt::print("{:<52} {:>10} {:>10} {:>7}\n", "", "corpus", "reference", "ratio");
    bool close = compare("principal components at 70 % of the variance",
                         components_at_70_percent(corpus, threads),
                         components_at_70_percent(reference, threads));
    close &= compare("cm to the 10th neighbour in the take, F45 at 30 Hz",
                     neighbour_distance(corpus, threads), neighbour_distance(reference, threads));
    close &= compare("frames a letter, one cluster for 25 frames",
                     frames_per_letter(corpus, letter_frames, threads),
                     frames_per_letter(reference, letter_frames, threads));
    return close ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run({argv + 1, argv + argc});
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 70;
    }
}
