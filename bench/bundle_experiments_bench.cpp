// What S1 §3.6 and §5 say of motion bundles, tried on motion whose truth is known.
//
//   bundle_experiments_bench --experiment generated|kappa|noise|scale|whole [--frames N] [--seeds
//   N...]
//       [--starts N] [--threads N] [CORPUS]
//       generated: purity, coverage and recall of repetitions with default options
//       kappa: are left and right punches kept apart, by frames a cluster?
//       noise: 0.1 σ on each degree of freedom, beside other starts of EM
//       scale: time and memory of many subjects with letters of their own; CORPUS: more takes,
//       NN/NN.asf and NN/NN_*.amc, as `kinetome generate --from` makes them
//       whole: the same of one string; takes of CORPUS again and again, at other paces
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "found_bundles.h"
#include "generated_corpus.h"
#include "kinetome/base/resources.h"
#include "kinetome/synthesis/clip_variation.h"
#include "program.h"

namespace {

using namespace kinetome;
namespace fs = std::filesystem;

struct Options {
    std::string experiment = "generated";
    int64_t frames = 0;  ///< 0: as the experiment has it
    std::vector<uint64_t> seeds = {1, 2, 3};
    int starts = 6;
    int threads = 2;
    fs::path corpus;

    int64_t frames_or(int64_t usual) const { return frames > 0 ? frames : usual; }
};

/// Bundle of each frame, by take; no_class outside those that have several members.
std::vector<FrameClasses> bundles_of_frames(const bench::SpelledTakes& takes,
                                            const std::vector<SubstringBundle>& bundles,
                                            const std::vector<int64_t>& frames) {
    std::vector<FrameClasses> of_takes;
    for (const int64_t count : frames) of_takes.emplace_back(size_t(count), no_class);
    for (size_t b = 0; b < bundles.size() && !bundles[b].is_degenerate(); ++b) {
        for (const Substring& member : bundles[b].members) {
            auto& of_take = of_takes[size_t(takes.string.clip[size_t(member.first)])];
            const auto first = int64_t(takes.string.mean_frame(member.first));
            const auto end = int64_t(takes.string.mean_frame(member.last));
            std::fill(of_take.begin() + first, of_take.begin() + end, int32_t(b));
        }
    }
    return of_takes;
}

/// The class that most frames of each bundle have.
std::map<int32_t, int32_t> main_classes(const std::vector<FrameClasses>& bundles,
                                        const std::vector<FrameClasses>& classes) {
    std::map<int32_t, std::map<int32_t, int64_t>> counts;
    for (size_t take = 0; take < bundles.size(); ++take) {
        for (size_t frame = 0; frame < bundles[take].size(); ++frame)
            ++counts[bundles[take][frame]][classes[take][frame]];
    }
    std::map<int32_t, int32_t> main;
    for (const auto& [bundle, of_bundle] : counts) {
        main[bundle] = std::ranges::max_element(of_bundle, {}, [](const auto& entry) {
                           return entry.second;
                       })->first;
    }
    return main;
}

bench::PoseTakes poses_of(const bench::GeneratedCorpus& corpus) {
    return bench::PoseTakes::of_clips(corpus.names(), corpus.clips);
}

/// Share of the repetitions of each label that lie, by half or more, in bundles of that label.
void print_recall(const bench::GeneratedCorpus& corpus, const std::vector<FrameClasses>& bundles) {
    const auto main = main_classes(bundles, corpus.classes);
    std::map<std::string, std::pair<int64_t, int64_t>> found;  // recalled, all
    for (size_t take = 0; take < corpus.plans.size(); ++take) {
        for (const CycleRow& cycle : annotate(corpus.plans[take]).cycles) {
            int64_t right = 0;
            for (int64_t frame = cycle.first; frame < cycle.end; ++frame) {
                const int32_t bundle = bundles[take][size_t(frame)];
                const int32_t label = main.at(bundle);
                right += bundle != no_class && corpus.labels[size_t(label)] == cycle.label;
            }
            auto& [recalled, all] = found[cycle.label];
            recalled += 2 * right >= cycle.end - cycle.first;
            ++all;
        }
    }
    for (const auto& [label, counts] : found)
        fmt::print("  {} {}/{}", label, counts.first, counts.second);
    fmt::print("\n");
}

void generated(const Options& options) {
    fmt::print("target: purity 0.97 at coverage 0.5\n");
    fmt::print("seed purity control cover. bundles height  recall of repetitions\n");
    for (const uint64_t seed : options.seeds) {
        const bench::GeneratedCorpus corpus(options.frames_or(40'000), 4, seed, options.threads);
        const bench::PoseTakes takes = poses_of(corpus);
        const bench::SpelledTakes spelled(takes, {}, options.threads);
        const auto bundles = bench::find(spelled, {}, options.threads).bundles;
        const BundleScore one = bench::score(spelled.string, bundles, corpus.classes);
        fmt::print("{:>4} {:>6.3f} {:>7.3f} {:>6.3f} {:>7} {:>6.2f}", seed, one.purity,
                   one.shuffled, one.coverage, one.bundles, one.mean_height);
        print_recall(corpus, bundles_of_frames(spelled, bundles, takes.frames));
        std::fflush(stdout);
    }
}

/// Share of the frames of left and right punches in bundles that lies on the side that fewer of
/// their bundle's punches are on; and the share that lies in bundles at all.
std::pair<double, double> mixed_punches(const bench::GeneratedCorpus& corpus,
                                        const std::vector<FrameClasses>& bundles) {
    std::map<int32_t, std::array<int64_t, 2>> sides;
    int64_t all = 0;
    for (size_t take = 0; take < bundles.size(); ++take) {
        for (size_t frame = 0; frame < bundles[take].size(); ++frame) {
            const int32_t label = corpus.classes[take][frame];
            if (label == no_class) continue;
            const std::string& name = corpus.labels[size_t(label)];
            if (name != "punch_left" && name != "punch_right") continue;
            ++all;
            const int32_t bundle = bundles[take][frame];
            if (bundle != no_class) ++sides[bundle][name == "punch_left" ? 0 : 1];
        }
    }
    int64_t mixed = 0, covered = 0;
    for (const auto& [bundle, of_bundle] : sides) {
        mixed += std::min(of_bundle[0], of_bundle[1]);
        covered += of_bundle[0] + of_bundle[1];
    }
    return {double(mixed) / double(std::max<int64_t>(covered, 1)),
            double(covered) / double(std::max<int64_t>(all, 1))};
}

void kappa(const Options& options) {
    fmt::print("S1 3.6: with too few clusters left and right jabs are mixed\n");
    fmt::print("seed frames/cluster  kappa purity cover. mixed punches  punches covered\n");
    for (const uint64_t seed : options.seeds) {
        const bench::GeneratedCorpus corpus(options.frames_or(40'000), 1, seed, options.threads);
        const bench::PoseTakes takes = poses_of(corpus);
        for (const double ratio : {25., 50., 100., 200., 400., 800., 1600.}) {
            PoseClusterOptions clusters;
            clusters.clusters = std::llround(double(corpus.frames()) / ratio);
            const bench::SpelledTakes spelled(takes, clusters, options.threads);
            const auto bundles = bench::find(spelled, {}, options.threads).bundles;
            const BundleScore one = bench::score(spelled.string, bundles, corpus.classes);
            const auto [mixed, covered] =
                mixed_punches(corpus, bundles_of_frames(spelled, bundles, takes.frames));
            fmt::print("{:>4} {:>14} {:>6} {:>6.3f} {:>6.3f} {:>13.3f} {:>16.3f}\n", seed, ratio,
                       clusters.clusters, one.purity, one.coverage, mixed, covered);
            std::fflush(stdout);
        }
    }
}

/// Mean over the bundles of the one of the best overlap with a bundle of the other: frames of both
/// over frames of either.
double best_jaccard(const std::vector<FrameClasses>& one, const std::vector<FrameClasses>& other) {
    std::map<int32_t, int64_t> of_one, of_other;
    std::map<std::pair<int32_t, int32_t>, int64_t> of_both;
    for (size_t take = 0; take < one.size(); ++take) {
        for (size_t frame = 0; frame < one[take].size(); ++frame) {
            const int32_t a = one[take][frame], b = other[take][frame];
            if (a != no_class) ++of_one[a];
            if (b != no_class) ++of_other[b];
            if (a != no_class && b != no_class) ++of_both[{a, b}];
        }
    }
    std::map<int32_t, double> best;
    for (const auto& [pair, both] : of_both) {
        const int64_t either = of_one[pair.first] + of_other[pair.second] - both;
        best[pair.first] = std::max(best[pair.first], double(both) / double(either));
    }
    double sum = 0;
    for (const auto& [bundle, value] : best) sum += value;
    return of_one.empty() ? 0 : sum / double(of_one.size());
}

void noise(const Options& options) {
    fmt::print("beside the first start of EM on clean motion\n");
    fmt::print("seed motion start purity cover. bundles Jaccard\n");
    for (const uint64_t seed : options.seeds) {
        const bench::GeneratedCorpus corpus(options.frames_or(10'000), 1, seed, options.threads);
        const bench::PoseTakes clean = poses_of(corpus);
        bench::PoseTakes noisy = clean;
        bench::add_noise(noisy);
        std::vector<FrameClasses> first;
        for (const bench::PoseTakes* takes :
             std::array<const bench::PoseTakes*, 2>{&clean, &noisy}) {
            for (int start = 1; start <= options.starts; ++start) {
                PoseClusterOptions clusters;
                clusters.mixture.seed = uint64_t(start);
                const bench::SpelledTakes spelled(*takes, clusters, options.threads);
                const auto bundles = bench::find(spelled, {}, options.threads).bundles;
                const BundleScore one = bench::score(spelled.string, bundles, corpus.classes);
                const auto of_frames = bundles_of_frames(spelled, bundles, takes->frames);
                if (first.empty()) first = of_frames;
                fmt::print("{:>4} {:>6} {:>5} {:>6.3f} {:>6.3f} {:>7} {:>7.3f}\n", seed,
                           takes == &clean ? "clean" : "noisy", start, one.purity, one.coverage,
                           one.bundles, best_jaccard(first, of_frames));
                std::fflush(stdout);
            }
        }
    }
}

struct Sums {
    int64_t frames = 0, letters = 0, bundles = 0, partitions = 0;
    bench::Cost fit, extraction;

    void add(const bench::PoseTakes& takes, int threads) {
        std::vector<bench::SpelledTakes> spelled;
        const bench::Cost fitted =
            bench::cost_of([&] { spelled.emplace_back(takes, PoseClusterOptions{}, threads); });
        std::vector<SubstringBundle> found;
        const bench::Cost extracted =
            bench::cost_of([&] { found = bench::find(spelled[0], {}, threads).bundles; });
        fit.wall += fitted.wall;
        fit.cpu += fitted.cpu;
        extraction.wall += extracted.wall;
        extraction.cpu += extracted.cpu;
        frames += takes.poses.rows();
        letters += spelled[0].string.size();
        bundles += std::ranges::count_if(
            found, [](const SubstringBundle& bundle) { return !bundle.is_degenerate(); });
        ++partitions;
    }
    void print(const char* what) const {
        fmt::print(
            "{:<20} {:>8} frames {:>4} subjects {:>7} letters {:>7} bundles; letters {:.1f} "
            "cpu s; bundles {:.2f} s, {:.2f} cpu s; peak {}\n",
            what, frames, partitions, letters, bundles, fit.cpu, extraction.wall, extraction.cpu,
            describe_bytes(peak_resident_bytes()));
        std::fflush(stdout);
    }
};

void scale(const Options& options) {
    fmt::print("target: 2.5 million frames in 30 s and 4 GB\n");
    Sums sums;
    if (!options.corpus.empty()) {
        std::map<std::string, std::vector<std::string>> of_subjects;
        for (const fs::path& file : bench::amc_files(options.corpus))
            of_subjects[file.parent_path().filename().string()].push_back(file.stem().string());
        for (auto& [subject, names] : of_subjects) {
            std::ranges::sort(names);
            sums.add(bench::PoseTakes::read(options.corpus, names), options.threads);
        }
        sums.print("takes of the folder");
    }
    // Corpora of one subject each: its letters are its own, and one is in memory at a time.
    constexpr int64_t frames_of_subject = 50'000;
    const int64_t missing = options.frames_or(2'500'000) - sums.frames;
    for (int64_t subject = 0; subject * frames_of_subject < missing; ++subject) {
        const int64_t frames = std::min(frames_of_subject, missing - subject * frames_of_subject);
        const bench::GeneratedCorpus corpus(frames, 1, options.seeds.front() + uint64_t(subject),
                                            options.threads);
        sums.add(poses_of(corpus), options.threads);
    }
    sums.print("with generated ones");
}

/// Takes of a folder, and the same at other paces until there are frames enough, spelled with the
/// letters of the takes: as if one partition held them all.
struct PacedCorpus {
    Mixture mixture;
    MotionString string;
    std::vector<int64_t> frames;  ///< of the takes

    PacedCorpus(const fs::path& corpus, int64_t wanted, uint64_t seed, int threads) {
        const Workers workers{threads, nullptr};
        std::vector<fs::path> files = bench::amc_files(corpus);
        std::ranges::sort(files);
        std::vector<Clip> clips;
        std::vector<std::string> names;
        for (const fs::path& file : files) {
            clips.push_back(resample(bench::read_take(file), bench::pose_rate));
            names.push_back(file.stem().string());
        }
        std::vector<int32_t> letters;
        Pca pca;
        {
            const auto takes = bench::PoseTakes::of_clips(names, clips);
            pca =
                fit_pca(moments_of(takes.poses), takes.floors, PoseClusterOptions{}.variance_share);
            const MatrixF projected = pca.project(takes.poses);
            const MatrixRows rows(projected);
            mixture = fit_pose_clusters(rows, {}, workers).fit.model;
            letters = likeliest_clusters(mixture, rows, workers);
            frames = takes.frames;
        }
        for (uint64_t take = 0; static_cast<int64_t>(letters.size()) < wanted; ++take) {
            const Clip& clip = clips[take % clips.size()];
            RandomStream random(seed, "paced corpus", take);
            const Clip paced =
                sample(clip, TimeWarp(clip.frames(), random).source_frames(), clip.rate);
            const MatrixF projected =
                pca.project(pose_vectors(*paced.skeleton, paced.motion, paced.rate));
            const auto of_take = likeliest_clusters(mixture, MatrixRows(projected), workers);
            letters.insert(letters.end(), of_take.begin(), of_take.end());
            frames.push_back(paced.frames());
        }
        string = make_motion_string(letters, frames);
    }
};

void whole(const Options& options) {
    fmt::print("target: 2.5 million frames in 30 s and 4 GB\n");
    const PacedCorpus corpus(options.corpus, options.frames_or(2'500'000), options.seeds.front(),
                             options.threads);
    const MotionStringOptions spelling;
    const double tau = adjacent_distance(corpus.string, corpus.mixture, spelling.tau_quantile);
    const int64_t lambda =
        longest_substring(corpus.string, spelling.longest_submotion * bench::pose_rate);
    fmt::print("{} frames in {} takes, {} clusters, {} letters, lambda {}; peak so far {}\n",
               std::accumulate(corpus.frames.begin(), corpus.frames.end(), int64_t{0}),
               corpus.frames.size(), corpus.mixture.clusters(), corpus.string.size(), lambda,
               describe_bytes(peak_resident_bytes()));
    const AccessibilityMatrix accessible = accessibility_for_bundles(
        accessibility(corpus.mixture, tau, options.threads), corpus.string, corpus.mixture, {});
    std::vector<SubstringBundle> first;
    for (const uint64_t mebibytes : {16, 512}) {
        std::vector<SubstringBundle> bundles;
        const bench::Cost cost = bench::cost_of([&] {
            bundles =
                find_motion_bundles(corpus.string, accessible, lambda, {},
                                    {.threads = options.threads, .table_bytes = mebibytes << 20U});
        });
        if (first.empty()) first = bundles;
        fmt::print("tables of {:>3} MiB: {:.2f} s, {:.2f} cpu s, {} bundles, {}; peak {}\n",
                   mebibytes, cost.wall, cost.cpu,
                   std::ranges::count_if(bundles, [](const auto& one) { return one.height() > 1; }),
                   bundles == first ? "the same" : "OTHERS", describe_bytes(peak_resident_bytes()));
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::map<std::string, void (*)(const Options&)> experiments = {{"generated", generated},
                                                                         {"kappa", kappa},
                                                                         {"noise", noise},
                                                                         {"scale", scale},
                                                                         {"whole", whole}};
    std::vector<std::string> names;
    for (const auto& [name, experiment] : experiments) names.push_back(name);
    Options options;
    bench::Program program(
        "What S1 3.6 and 5 say of motion bundles, on motion whose truth is known");
    program.choice("--experiment", options.experiment, names);
    program.option("--frames", options.frames, "0: as the experiment has it");
    program.option("--seeds", options.seeds, "of generated corpora");
    program.count("--starts", options.starts, "of EM");
    program.count("--threads", options.threads);
    program.argument("corpus", options.corpus, "folder with NN/NN.asf and NN/NN_*.amc",
                     bench::Program::Need::optional);
    return program.run(argc, argv, [&] {
        experiments.at(options.experiment)(options);
        return true;
    });
}
