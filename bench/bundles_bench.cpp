// How pure, wide and tall are motion bundles, and how fast are they found?
//
//   bundles_bench CORPUS TRUTH [--set takes|subjects|corpus|known] [--starts N] [--spread S]
//       [--tau-quantile Q] [--step-quantile Q] [--member-length L]
//       [--threads N] [--curve] [--noise]
//       CORPUS: a folder with NN/NN.asf and NN/NN_*.amc
//       TRUTH: CSV of its annotated activities (clip,first,end,label,end_lo,end_hi)
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "cost.h"
#include "found_bundles.h"
#include "kinetome/formats/annotation.h"
#include "kinetome/models/bundle_graph.h"
#include "kinetome/models/bundle_score.h"
#include "kinetome/models/motion_bundle.h"
#include "program.h"
#include "spelled_takes.h"

namespace {

using namespace kinetome;
using bench::add_noise;
using bench::Found;
using bench::score;
namespace fs = std::filesystem;

/// What bundles are sought by.
struct Setting {
    MotionBundleOptions bundles;
    double tau_quantile = MotionStringOptions{}.tau_quantile;
    double tau_factor = 1;
};

struct Options {
    fs::path corpus, truth;
    int starts = 12;
    int threads = 2;
    std::string spread;
    bool curve = false;
    bool noise = false;  ///< S1 §5.1's, on the annotated takes
    Setting setting;     ///< where nothing else is tried
};

Found find(const bench::SpelledTakes& takes, const Setting& setting, int threads) {
    const double tau = adjacent_distance(takes.string, takes.mixture, setting.tau_quantile);
    return bench::find(takes, setting.bundles, threads, tau * setting.tau_factor);
}

using LabelsOfTakes = std::map<std::string, std::vector<TruthRow>>;

LabelsOfTakes read_labels(const fs::path& truth) {
    LabelsOfTakes labels;
    for (TruthRow& row : parse_truth_csv(read_source_file(truth), truth.string()))
        labels[row.clip].push_back(row);
    return labels;
}

/// One list a take, empty where it has no labels; a number for each label.
std::vector<FrameClasses> classes_of(const bench::PoseTakes& takes, const LabelsOfTakes& labels) {
    std::map<std::string, int32_t> numbers;
    std::vector<FrameClasses> classes;
    for (size_t i = 0; i < takes.names.size(); ++i) {
        FrameClasses of_take;
        const auto found = labels.find(takes.names[i]);
        if (found != labels.end()) {
            of_take.assign(static_cast<size_t>(takes.frames[i]), no_class);
            for (const TruthRow& row : found->second) {
                const int32_t number =
                    numbers.emplace(row.label, static_cast<int32_t>(numbers.size())).first->second;
                for (int64_t frame = row.first; frame < std::min(row.end, takes.frames[i]); ++frame)
                    of_take[static_cast<size_t>(frame)] = number;
            }
        }
        classes.push_back(std::move(of_take));
    }
    return classes;
}

const std::vector<std::vector<std::string>> labelled_sets = {
    {"14_14"}, {"13_29"}, {"13_29", "13_30", "13_31"}, {"86_01"}};

std::string name_of(const std::vector<std::string>& takes) {
    std::string name = takes.front();
    for (size_t i = 1; i < takes.size(); ++i) name += "+" + takes[i].substr(takes[i].find('_') + 1);
    return name;
}

struct LabelledSet {
    std::vector<FrameClasses> classes;
    std::vector<bench::SpelledTakes> starts;  ///< of EM
};

/// Mean and worst over starts of EM.
void judge(const std::vector<LabelledSet>& sets, const Setting& setting) {
    for (size_t set = 0; set < labelled_sets.size(); ++set) {
        double purity = 0, worst = 1, coverage = 0, height = 0, shuffled = 0, least_coverage = 1;
        std::vector<double> widths, seconds;
        for (const auto& takes : sets[set].starts) {
            const Found found = find(takes, setting, 1);
            const BundleScore one = score(takes.string, found.bundles, sets[set].classes);
            purity += one.purity;
            worst = std::min(worst, one.purity);
            coverage += one.coverage;
            least_coverage = std::min(least_coverage, one.coverage);
            height += one.mean_height;
            shuffled += one.shuffled;
            widths.push_back(one.median_width);
            seconds.push_back(found.seconds);
        }
        const auto n = static_cast<double>(sets[set].starts.size());
        fmt::print(
            "{:<14} {:<14} {:>4.2f} {:>5.2f} {:>4.2f} {:>5.2f} {:>6.3f} {:>6.3f} {:>6.3f} {:>6.3f} "
            "{:>6.2f} {:>6.0f} {:>6.2f} {:>6.1f}\n",
            name_of(labelled_sets[set]), spread_text(setting.bundles), setting.tau_quantile,
            setting.tau_factor, setting.bundles.step_quantile, setting.bundles.gamma, purity / n,
            worst, coverage / n, least_coverage, height / n, bench::median(widths), shuffled / n,
            1e3 * bench::median(seconds));
    }
}

/// Each of what bundles are sought by, the others at their defaults.
std::vector<Setting> curve() {
    std::vector<Setting> settings;
    for (const char* spread : {"closure", "closure-near", "closure-length", "depth:1", "depth:2",
                               "depth:3", "depth:4"}) {
        parse_spread(spread, settings.emplace_back().bundles);
    }
    for (const double quantile : {0.5, 0.6, 0.7, 0.8, 0.9})
        settings.emplace_back().tau_quantile = quantile;
    for (const double factor : {0.7, 0.85, 1.15, 1.3, 1.6})
        settings.emplace_back().tau_factor = factor;
    for (const double quantile : {0.5, 0.6, 0.9, 1.})
        settings.emplace_back().bundles.step_quantile = quantile;
    for (const double gamma : {0., 0.5, 0.65, 0.9}) settings.emplace_back().bundles.gamma = gamma;
    // As S1 has it, but for how far the relation is spread.
    for (const char* spread : {"closure", "closure-near", "closure-length", "depth:1", "depth:2"}) {
        Setting& setting = settings.emplace_back();
        parse_spread(spread, setting.bundles);
        setting.bundles.step_quantile = 1;
        setting.tau_quantile = 0.5;
    }
    return settings;
}

void judge_labelled_takes(const Options& options) {
    const LabelsOfTakes labels = read_labels(options.truth);
    std::vector<LabelledSet> sets;
    for (const auto& names : labelled_sets) {
        auto takes = bench::PoseTakes::read(options.corpus, names);
        if (options.noise) add_noise(takes);
        LabelledSet& set = sets.emplace_back();
        set.classes = classes_of(takes, labels);
        for (int start = 0; start < options.starts; ++start) {
            PoseClusterOptions clusters;
            clusters.mixture.seed = static_cast<uint64_t>(start + 1);
            set.starts.emplace_back(takes, clusters, options.threads);
        }
    }
    fmt::print("tau: quantile of adjacent distances, times a factor; step: step_quantile\n");
    fmt::print(
        "takes          spread          tau times step gamma purity worst  cover. least  height  "
        "width control   ms\n");
    judge(sets, options.setting);
    if (!options.curve) return;
    for (const Setting& one : curve()) judge(sets, one);
}

/// Bundles as "height x mean frames", those with most frames first.
std::string largest_of(const MotionString& string, const std::vector<SubstringBundle>& bundles) {
    std::vector<std::pair<double, std::string>> all;
    for (const SubstringBundle& bundle : bundles) {
        if (bundle.is_degenerate()) continue;
        double frames = 0;
        for (const Substring& member : bundle.members)
            frames += string.mean_frame(member.last) - string.mean_frame(member.first);
        all.emplace_back(-frames, fmt::format("{}x{:.0f}", bundle.height(),
                                              frames / static_cast<double>(bundle.height())));
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::string text;
    for (size_t i = 0; i < std::min<size_t>(all.size(), 6); ++i) text += " " + all[i].second;
    return text;
}

/// Groups of nodes that edges join in either direction.
int64_t weak_components(const MotionGraph& graph) {
    std::vector<int32_t> group(static_cast<size_t>(graph.nodes()));
    for (int32_t node = 0; node < graph.nodes(); ++node) group[static_cast<size_t>(node)] = node;
    const auto root = [&](int32_t node) {
        while (group[static_cast<size_t>(node)] != node) node = group[static_cast<size_t>(node)];
        return node;
    };
    int64_t groups = graph.nodes();
    for (int32_t node = 0; node < graph.nodes(); ++node) {
        for (const int32_t target : graph.targets(node)) {
            const int32_t a = root(node), b = root(target);
            if (a == b) continue;
            group[static_cast<size_t>(std::max(a, b))] = std::min(a, b);
            --groups;
        }
    }
    return groups;
}

struct KnownSet {
    std::vector<std::string> takes;
    int64_t clusters;
    double rho;
    bool noise = false;
};

/// Structure, graph, milliseconds of one start of EM.
void describe(const KnownSet& set, const bench::PoseTakes& takes, uint64_t start,
              const Options& options) {
    PoseClusterOptions clusters;
    clusters.clusters = set.clusters;
    clusters.mixture.seed = start;
    const bench::SpelledTakes spelled(takes, clusters, options.threads);
    Setting setting = options.setting;
    setting.bundles.rho = set.rho;
    std::vector<double> seconds;
    Found found;
    for (int turn = 0; turn < 9; ++turn) {
        found = find(spelled, setting, 1);
        seconds.push_back(found.seconds);
    }
    // Each take is a class of its own: a bundle is mixed if it is not pure.
    std::vector<FrameClasses> classes;
    for (size_t i = 0; i < takes.frames.size(); ++i)
        classes.emplace_back(static_cast<size_t>(takes.frames[i]), static_cast<int32_t>(i));
    const BundleScore one = score(spelled.string, found.bundles, classes);
    std::vector<int32_t> node_of, f;
    int32_t nodes = 0;
    for (const SubstringBundle& bundle : found.bundles)
        node_of.push_back(bundle.is_degenerate() ? -1 : nodes++);
    for (int64_t j = 0; j < spelled.string.size(); ++j)
        f.push_back(static_cast<int32_t>(spelled.string.mean_frame(j)));
    BundleGraph graph;
    const double graph_seconds =
        bench::cost_of([&] {
            graph = bundle_graph(bundle_members(spelled.string, found.bundles, f), node_of, nodes,
                                 takes.frames);
        }).wall;
    size_t strong = 0;
    for (const auto& component : strong_components(graph.graph).nodes)
        strong = std::max(strong, component.size());
    fmt::print(
        "{:<14} {:>5} {:>3} {:>5} {:>5} {:>6} {:>3} {:>7} {:>6} {:>7} {:>6.2f} {:>5.3f} {:>5} "
        "{:>5} {:>6} "
        "{:>4} {:>5.1f} {:>5.2f} {}\n",
        name_of(set.takes), set.clusters, set.rho, set.noise ? "0.1" : "-", start,
        takes.poses.rows(), spelled.projected.cols(), spelled.string.size(), spelled.lambda,
        one.bundles, one.coverage, 1 - one.purity, graph.graph.nodes(), graph.graph.edges(), strong,
        weak_components(graph.graph), 1e3 * bench::median(seconds), 1e3 * graph_seconds,
        largest_of(spelled.string, found.bundles));
}

/// Sets whose bundles S1 §5 describes, or is likely to.
void describe_known_takes(const Options& options) {
    const std::vector<KnownSet> sets = {{{"02_05"}, 80, 1},           {{"02_05"}, 80, 2},
                                        {{"02_05"}, 80, 1, true},     {{"03_03"}, 200, 1},
                                        {{"03_03"}, 200, 2},          {{"14_02"}, 250, 1},
                                        {{"14_02"}, 250, 2},          {{"14_02"}, 250, 1, true},
                                        {{"02_05", "03_03"}, 250, 1}, {{"13_29", "13_30"}, 250, 1}};
    fmt::print(
        "takes          kappa rho noise start frames PCs letters lambda bundles cover. mixed nodes "
        "edges strong weak    ms graph  largest\n");
    for (const KnownSet& set : sets) {
        auto takes = bench::PoseTakes::read(options.corpus, set.takes);
        if (set.noise) add_noise(takes);
        for (int start = 1; start <= options.starts; ++start)
            describe(set, takes, static_cast<uint64_t>(start), options);
    }
}

std::vector<std::string> all_takes(const fs::path& corpus) {
    std::vector<std::string> names;
    for (const fs::path& file : bench::amc_files(corpus)) names.push_back(file.stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

/// Labelled takes among all others, letters shared by the takes of a subject or by all.
void judge_corpus(const Options& options, bool by_subject) {
    const LabelsOfTakes labels = read_labels(options.truth);
    std::map<std::string, std::vector<std::string>> partitions;
    for (const std::string& name : all_takes(options.corpus))
        partitions[by_subject ? name.substr(0, name.find('_')) : "all"].push_back(name);
    std::vector<std::pair<bench::SpelledTakes, std::vector<FrameClasses>>> spelled;
    int64_t frames = 0, letters = 0;
    for (const auto& [partition, names] : partitions) {
        const auto takes = bench::PoseTakes::read(options.corpus, names);
        spelled.emplace_back(bench::SpelledTakes(takes, {}, options.threads),
                             classes_of(takes, labels));
        frames += takes.poses.rows();
        letters += spelled.back().first.string.size();
    }
    fmt::print("{} frames, {} letters, letters shared by {}\n", frames, letters,
               by_subject ? "subject" : "all");
    fmt::print("spread         purity cover. control   bundles height  seconds\n");
    std::vector<std::string> spreads = {"depth:1",      "depth:2",        "depth:3",
                                        "closure-near", "closure-length", "closure"};
    if (!options.spread.empty()) spreads = {options.spread};
    for (const std::string& spread : spreads) {
        Setting setting = options.setting;
        parse_spread(spread, setting.bundles);
        double seconds = 0;
        int64_t count = 0;
        double pure = 0, covered = 0, labelled = 0, height = 0, shuffled = 0;
        for (const auto& [takes, classes] : spelled) {
            const Found found = find(takes, setting, options.threads);
            seconds += found.seconds;
            const BundleScore one = score(takes.string, found.bundles, classes);
            double frames_here = 0;
            for (const FrameClasses& of_take : classes) frames_here += double(of_take.size());
            labelled += frames_here;
            covered += one.coverage * frames_here;
            pure += one.purity * one.coverage * frames_here;
            shuffled += one.shuffled * one.coverage * frames_here;
            count += one.bundles;
            height += one.mean_height * double(one.bundles);
        }
        fmt::print("{:<14} {:>6.3f} {:>6.3f} {:>7.3f} {:>9} {:>6.2f} {:>8.3f}\n", spread,
                   pure / covered, covered / labelled, shuffled / covered, count,
                   height / double(count), seconds);
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    std::string set = "takes", member_length = "seed";
    bench::Program program(
        "How pure, wide and tall are motion bundles, and how fast are they found?");
    program.argument("corpus", options.corpus, "folder with NN/NN.asf and NN/NN_*.amc");
    program.argument("truth", options.truth, "CSV of its annotated activities");
    program.choice("--set", set, {"takes", "subjects", "corpus", "known"}, "of takes");
    program.count("--starts", options.starts, "of EM");
    program.count("--threads", options.threads);
    program.option("--spread", options.spread, "as that of kinetome reindex");
    program.option("--tau-quantile", options.setting.tau_quantile);
    program.option("--step-quantile", options.setting.bundles.step_quantile);
    program.choice("--member-length", member_length, {"seed", "mean"},
                   "as that of kinetome reindex");
    program.flag("--curve", options.curve,
                 "by spread, quantiles, τ and γ, the others at their defaults");
    program.flag("--noise", options.noise, "a tenth of σ on every column of the annotated takes");
    return program.run(argc, argv, [&] {
        if (!options.spread.empty()) parse_spread(options.spread, options.setting.bundles);
        if (member_length == "mean") options.setting.bundles.member_length = MemberLength::mean;
        if (set == "takes") judge_labelled_takes(options);
        if (set == "subjects") judge_corpus(options, true);
        if (set == "known") describe_known_takes(options);
        if (set == "corpus") judge_corpus(options, false);
        return true;
    });
}
