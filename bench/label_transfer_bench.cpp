// How far can transferred labels be trusted, and how fast are they transferred?
//
//   label_transfer_bench CORPUS TRUTH [--takes NAME,…] [--seeds N,…] [--frames N] [--turns N] …
//       CORPUS: a folder with NN/NN.asf and NN/NN_*.amc
//       TRUTH: CSV of its annotated activities (clip,first,end,label,end_lo,end_hi)
//
// Prints precision and recall of labels transferred to each of the takes from the others, beside
// those of the nearest neighbour by plain dynamic time warping, at every distance up to which one
// may trust it; S3's table 1, of the first take, the first two, …; the same of generated corpora,
// whose labels are known; and how long the labels of 480 primitives last, by 50 others.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "cost.h"
#include "kinetome/models/label_table.h"
#include "labelled_primitives.h"
#include "nearest_by_warping.h"
#include "program.h"

namespace {

using namespace kinetome;
using namespace kinetome::bench;
namespace fs = std::filesystem;

struct Options {
    fs::path corpus, truth;
    std::vector<std::string> takes{"13_29", "13_30", "13_31", "14_14"};
    std::vector<uint64_t> seeds{11, 12, 13, 14};
    int64_t frames = 60000;
    int64_t subjects = 3;
    int threads = 2;
    int turns = 9;
};

/// The label given to each primitive by those of the other clips.
std::vector<int32_t> labels_by_others(const Labelled& data, const LabelTransferOptions& options,
                                      int threads) {
    const auto& all = data.primitives.all;
    std::vector<int32_t> given(all.size(), -1);
    for (const int64_t clip : data.primitives.clips()) {
        std::vector<int32_t> known = data.labels;
        std::vector<CorpusPrimitive> asked;
        std::vector<size_t> places;
        for (size_t p = 0; p < all.size(); ++p) {
            if (all[p].clip != clip) continue;
            known[p] = -1;
            asked.push_back(all[p]);
            places.push_back(p);
        }
        const KnowledgeBase base(data.primitives.movements, all, known);
        const auto guesses =
            transfer_labels(base, data.primitives.movements, asked, options, threads);
        for (size_t i = 0; i < places.size(); ++i) given[places[i]] = guesses[i].label;
    }
    return given;
}

void print_counts(const std::string& name, const LabelCounts& counts) {
    fmt::print("  {:<42} {:>8} {:>5} {:>7} {:>6}   {:.3f}     {:.3f}\n", name, counts.examples,
               counts.found, counts.correct, counts.missed, counts.precision(), counts.recall());
}

void print_head(const std::string& title) {
    fmt::print("\n{}\n{:<44} examples found correct missed precision recall\n", title, "");
}

/// Ours against the peers, at the precision that ours has and at the one asked for.
void compare(const Labelled& data, double wanted, int threads) {
    struct Way {
        const char* name;
        LabelTransferOptions options;
    };
    LabelTransferOptions all_known;
    all_known.recognised = 0.95;
    std::set<double> precisions{wanted};
    for (const Way& way :
         {Way{"ours", {}}, Way{"ours, where every movement has a label", all_known}}) {
        const auto given = labels_by_others(data, way.options, threads);
        const LabelCounts counts = label_table(data.labels, given, int32_t(data.names.size())).all;
        print_counts(way.name, counts);
        precisions.insert(counts.precision());
    }
    for (const Peer& peer : peers()) {
        const auto curve = curve_of(nearest_by_warping(data, peer.cost, threads));
        for (const double precision : precisions) {
            const Point best = best_at(curve, precision);
            fmt::print("  {:<42} up to {:>5.1f} cm, at ≥ {:.3f}:      {:.3f}     {:.3f}\n",
                       peer.name, best.cost, precision, best.precision, best.recall);
        }
        fmt::print("    its curve, precision/recall:");
        for (size_t i = curve.size() / 10; i > 0 && i <= curve.size(); i += curve.size() / 10) {
            fmt::print(" {:.3f}/{:.3f}", curve[i - 1].precision, curve[i - 1].recall);
        }
        fmt::print("\n");
    }
}

std::vector<CycleRow> read_truth(const fs::path& file, const std::vector<std::string>& takes) {
    std::vector<CycleRow> rows;
    for (TruthRow& row : parse_truth_csv(read_source_file(file), file.string())) {
        if (std::ranges::count(takes, row.clip) == 0) continue;
        rows.push_back({std::move(row.clip), row.first, row.end, std::move(row.label)});
    }
    return rows;
}

std::vector<NamedTake> read_takes(const Options& options) {
    std::vector<NamedTake> takes;
    for (const std::string& name : options.takes) {
        const std::string subject = name.substr(0, name.find('_'));
        takes.push_back({name, read_take(options.corpus / subject / (name + ".amc"))});
    }
    return takes;
}

/// S3's table 1.
void print_growing_knowledge(const Labelled& data, const Options& options) {
    std::vector<int64_t> known;
    for (int64_t clip = 0; clip + 1 < int64_t(options.takes.size()); ++clip) known.push_back(clip);
    const auto tables = label_tables(data.primitives.movements, data.primitives.all, data.labels,
                                     int32_t(data.names.size()), known, {}, options.threads);
    std::string knowledge;
    for (size_t k = 0; k < tables.size(); ++k) {
        knowledge += (k ? " & " : "") + options.takes[k];
        print_head("table 1, knowledge base: " + knowledge);
        for (size_t label = 0; label < data.names.size(); ++label) {
            const LabelCounts& counts = tables[k].labels[label];
            if (counts.examples + counts.found + counts.missed + counts.correct == 0) continue;
            print_counts(data.names[label], counts);
        }
        print_counts("all", tables[k].all);
    }
}

/// The first primitives of a corpus, and others of it with labels.
struct TransferTask {
    Primitives primitives;
    std::vector<CorpusPrimitive> asked;
    std::vector<int32_t> labels;
};

/// Each of the others has a label of its own, so that none spares another.
TransferTask transfer_task(const Options& options) {
    constexpr size_t asked = 480, known = 50;
    TransferTask task{find_in(read_all(options.corpus, options.threads), options.threads), {}, {}};
    const auto& all = task.primitives.all;
    if (all.size() < asked + known) throw UsageError("the corpus has too few primitives");
    task.asked.assign(all.begin(), all.begin() + asked);
    task.labels.assign(all.size(), -1);
    for (size_t i = 0; i < known; ++i) {
        task.labels[asked + i * (all.size() - asked) / known] = static_cast<int32_t>(i);
    }
    return task;
}

/// What `label_of` gives, by comparison with every known primitive.
int32_t label_by_all(const TransferTask& task, const CorpusPrimitive& primitive,
                     const LabelTransferOptions& options) {
    const auto rows_of = [&](const CorpusPrimitive& one) {
        return task.primitives.movements.middleRows(one.rows.first, one.rows.size());
    };
    double nearest = std::numeric_limits<double>::infinity(), next = nearest;
    int32_t label = -1;
    for (size_t p = 0; p < task.labels.size(); ++p) {
        if (task.labels[p] < 0) continue;
        double cost = std::numeric_limits<double>::infinity();
        const auto known = rows_of(task.primitives.all[p]);
        for (const WarpPath& path : warp_matches(rows_of(primitive), known, {})) {
            cost = std::min(cost, path.mean);
        }
        next = std::min(next, std::max(cost, nearest));
        if (cost < nearest) label = task.labels[p];
        nearest = std::min(nearest, cost);
    }
    return nearest <= options.threshold && next > nearest / options.lead ? label : -1;
}

std::string median_text(const std::vector<bench::Cost>& turns) {
    std::vector<double> wall, cpu;
    for (const bench::Cost& turn : turns) {
        wall.push_back(turn.wall);
        cpu.push_back(turn.cpu);
    }
    return fmt::format("{:.3f} s (processor: {:.3f} s)", median(wall), median(cpu));
}

/// Whether the labels are those of comparing with all.
bool time_transfer(const Options& options) {
    const TransferTask task = transfer_task(options);
    const LabelTransferOptions transfer;
    std::vector<LabelGuess> guesses;
    std::vector<int32_t> by_all(task.asked.size());
    std::vector<bench::Cost> ours, exhaustive;
    for (int turn = 0; turn < options.turns; ++turn) {
        ours.push_back(cost_of([&] {
            const KnowledgeBase base(task.primitives.movements, task.primitives.all, task.labels);
            guesses = transfer_labels(base, task.primitives.movements, task.asked, transfer, 1);
        }));
        exhaustive.push_back(cost_of([&] {
            for (size_t i = 0; i < by_all.size(); ++i) {
                by_all[i] = label_by_all(task, task.asked[i], transfer);
            }
        }));
    }
    const auto known = std::ranges::count_if(task.labels, [](int32_t label) { return label >= 0; });
    fmt::print("\n{} primitives by {} others, one thread: {}; by all paths: {}\n",
               task.asked.size(), known, median_text(ours), median_text(exhaustive));
    return std::ranges::equal(guesses, by_all, {}, &LabelGuess::label);
}

bool run(const Options& options) {
    const Labelled data = with_labels(find_in(read_takes(options), options.threads),
                                      read_truth(options.truth, options.takes));
    print_head(fmt::format("{} primitives, each take by the others", data.labels.size()));
    compare(data, 0.95, options.threads);
    print_growing_knowledge(data, options);
    for (const uint64_t seed : options.seeds) {
        const Labelled made = generated_primitives(
            {.frames = options.frames, .seed = seed, .subjects = options.subjects},
            options.threads);
        print_head(fmt::format("generated corpus {}: {} primitives, each take by the others", seed,
                               made.labels.size()));
        compare(made, 0.99, options.threads);
    }
    const bool same = time_transfer(options);
    if (!same) fmt::print(stderr, "labels differ from those of comparing with all\n");
    return same;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    bench::Program program(
        "How far can transferred labels be trusted, and how fast are they transferred?");
    program.argument("corpus", options.corpus, "folder with NN/NN.asf and NN/NN_*.amc");
    program.argument("truth", options.truth, "CSV of its annotated activities");
    program.option("--takes", options.takes, "annotated takes, separated by commas");
    program.option("--seeds", options.seeds, "of generated corpora, separated by commas");
    program.count("--frames", options.frames, "of each generated corpus");
    program.count("--subjects", options.subjects, "of each generated corpus");
    program.count("--turns", options.turns, "of the measurement of time");
    program.count("--threads", options.threads, "for all but the measurement of time");
    return program.run(argc, argv, [&] { return run(options); });
}
