// How well and how fast does the signature index find what exhaustive warping finds?
//
//   retrieval_bench CORPUS [TRUTH] [--tolerance MM] [--growth FRAMES ...
//                   [--growth-tolerance MM]] [--threads N]
//       CORPUS: a folder with NN/NN.asf and NN/NN_*.amc
//       TRUTH: CSV of its annotated activities (clip,first,end,label,end_lo,end_hi)
//
// Every 14th take by name is held out of the hierarchy and the index; queries of 2 seconds are
// taken from those. The peer compares each query with every part of every take by dynamic time
// warping (24 principal components of the markers at 30 Hz, at most twice as fast or slow).
#include <fmt/format.h>

#include <map>
#include <numeric>
#include <optional>

#include "cost.h"
#include "kinetome/synthesis/corpus_generator.h"
#include "kinetome/synthesis/take.h"
#include "program.h"
#include "searched_takes.h"

namespace {

using namespace kinetome;
using bench::Collection;
using bench::MarkerTake;
using bench::overlap;
using bench::Query;
using bench::query_frames;
namespace fs = std::filesystem;

constexpr int64_t answers = 10;

struct Options {
    fs::path corpus, truth;
    double tolerance = PoseHierarchyOptions{}.leaf_tolerance;
    std::vector<int64_t> growth;
    double growth_tolerance = 45;  ///< some 300 frames a leaf, as in S2 §5.1
    int threads = 2;
};

using Search = std::vector<IndexedMatch> (Collection::*)(const Query&, int64_t) const;

struct Method {
    const char* name;
    Search search;
};

constexpr Method methods[] = {{"warping", &Collection::by_warping},
                              {"signatures", &Collection::by_signature},
                              {"  and rerank", &Collection::by_signature_and_rerank}};

/// Four of each take that is long enough, evenly spread.
std::vector<Query> queries_of(const std::vector<MarkerTake>& takes) {
    constexpr int64_t each = 4;
    std::vector<Query> queries;
    for (const MarkerTake& take : takes) {
        const int64_t room = take.markers.rows() - query_frames;
        for (int64_t i = 0; i < each && room >= 0; ++i) {
            const int64_t first = room * (2 * i + 1) / (2 * each);
            queries.push_back({take.markers.middleRows(first, query_frames)});
        }
    }
    return queries;
}

bool same_place(const IndexedMatch& a, const IndexedMatch& b) {
    return a.clip == b.clip && is_same_place(a.match.frames, b.match.frames, overlap);
}

/// Milliseconds of processor time a query, the median of turns.
double cost_of_search(const Collection& collection, const std::vector<Query>& queries,
                      Search search, int turns) {
    std::vector<double> costs;
    for (int turn = 0; turn < turns; ++turn) {
        const auto cost = bench::cost_of([&] {
            for (const Query& query : queries) (collection.*search)(query, answers);
        });
        costs.push_back(1e3 * cost.cpu / double(queries.size()));
    }
    return bench::median(std::move(costs));
}

/// Recall and cost of each method's answers against those of warping.
void compare(const Collection& collection, const std::vector<Query>& queries) {
    fmt::print("{:<14} {:>10} {:>11} {:>9} {:>9}\n", "method", "recall@10", "cost ratio", "ms",
               "warping/x");
    const double warping_ms = cost_of_search(collection, queries, &Collection::by_warping, 3);
    for (const Method& method : methods) {
        double recall = 0, ratio = 0;
        for (const Query& query : queries) {
            const auto expected = collection.by_warping(query, answers);
            const auto found = (collection.*method.search)(query, answers);
            const auto known = std::ranges::count_if(expected, [&](const IndexedMatch& one) {
                return std::ranges::any_of(
                    found, [&](const IndexedMatch& other) { return same_place(one, other); });
            });
            const MatrixF features = collection.features(query.markers);
            double cost = 0, least = 0;
            for (const auto& one : found) cost += collection.warping_cost(features, one);
            for (const auto& one : expected) least += one.match.distance;
            recall += double(known) / double(expected.size());
            ratio += cost / double(found.size()) / (least / double(expected.size()));
        }
        const auto count = double(queries.size());
        const double ms = cost_of_search(collection, queries, method.search, 5);
        fmt::print("{:<14} {:>10.3f} {:>11.3f} {:>9.2f} {:>9.1f}\n", method.name, recall / count,
                   ratio / count, ms, warping_ms / ms);
    }
}

// Labels ------------------------------------------------------------------------------------------

struct LabelledTake {
    MarkerTake take;
    std::vector<TruthRow> rows;
};

/// The label that most of some frames have; "" for those without.
std::string label_at(const std::vector<TruthRow>& rows, const RowRange& frames) {
    std::map<std::string, int64_t> counts;
    for (const TruthRow& row : rows) {
        const int64_t shared = std::min(row.end, frames.end) - std::max(row.first, frames.first);
        if (shared > 0) counts[row.label] += shared;
    }
    std::string label;
    int64_t most = 0;
    for (const auto& [name, count] : counts) {
        if (count > most) label = name;
        most = std::max(most, count);
    }
    return label;
}

struct Tally {
    int64_t asked = 0;
    std::map<std::string, int64_t> right;  ///< by method
};

/// Asks for every 2 seconds of every span of `asked` among the takes of `known`.
void ask(const std::vector<LabelledTake>& known, const LabelledTake& asked,
         const PoseHierarchy& hierarchy, Tally& tally) {
    std::vector<MarkerTake> takes;
    for (const LabelledTake& one : known) takes.push_back(one.take);
    const Collection collection(takes, hierarchy, 1);
    for (const TruthRow& row : asked.rows) {
        const bool is_known = std::ranges::any_of(known, [&](const LabelledTake& one) {
            return std::ranges::any_of(one.rows,
                                       [&](const TruthRow& r) { return r.label == row.label; });
        });
        const int64_t last = std::min(row.end, asked.take.markers.rows()) - query_frames;
        for (int64_t first = row.first; is_known && first <= last; first += query_frames) {
            ++tally.asked;
            const Query query{asked.take.markers.middleRows(first, query_frames)};
            for (const Method& method : methods) {
                const auto found = (collection.*method.search)(query, 1);
                if (found.empty()) continue;
                const auto& rows = known[size_t(found.front().clip)].rows;
                tally.right[method.name] +=
                    label_at(rows, found.front().match.frames) == row.label ? 1 : 0;
            }
        }
    }
}

void print_tally(const std::string& what, const Tally& tally) {
    fmt::print("{} ({} queries), the first answer has the query's label:", what, tally.asked);
    for (const Method& method : methods) {
        const auto right = tally.right.find(method.name);
        fmt::print(" {} {:.3f}", method.name,
                   double(right == tally.right.end() ? 0 : right->second) / double(tally.asked));
    }
    fmt::print("\n");
}

/// Each annotated take among the other ones.
void judge_annotated(const Options& options, const std::vector<MarkerTake>& takes,
                     const PoseHierarchy& hierarchy) {
    std::map<std::string, LabelledTake> labelled;
    for (TruthRow& row : parse_truth_csv(read_source_file(options.truth), options.truth.string())) {
        LabelledTake& one = labelled[row.clip];
        const auto take = std::ranges::find(takes, row.clip, &MarkerTake::name);
        if (take == takes.end()) continue;
        one.take = *take;
        one.rows.push_back(std::move(row));
    }
    Tally tally;
    for (const auto& [name, asked] : labelled) {
        std::vector<LabelledTake> known;
        for (const auto& [other, one] : labelled) {
            if (other != name) known.push_back(one);
        }
        ask(known, asked, hierarchy, tally);
    }
    print_tally("annotated spans", tally);
}

/// Generated takes of several performers; every seventh asks.
void judge_generated(const Options& options) {
    constexpr int64_t count = 70, frames = 2400;
    std::vector<LabelledTake> known, asked;
    std::vector<MarkerTake> takes;
    for (int64_t i = 0; i < count; ++i) {
        const TakePlan plan = plan_take(i, frames, 1 + i / 10, 1 + i % 10, 3);
        const Clip clip = perform(plan, make_subject(1 + i / 10, 3), 3);
        LabelledTake one{{plan.name(), bench::markers_of(clip)}, annotate(plan).truth};
        if (i % 7 != 6) takes.push_back(one.take);
        (i % 7 == 6 ? asked : known).push_back(std::move(one));
    }
    const PoseHierarchy hierarchy = bench::hierarchy_of(takes, options.tolerance, options.threads);
    Tally tally;
    for (const LabelledTake& one : asked) ask(known, one, hierarchy, tally);
    print_tally("generated spans", tally);
}

// Pace and growth ---------------------------------------------------------------------------------

/// Every take whole, and 2 seconds of it, at another pace.
void judge_pace(const std::vector<bench::NamedClip>& clips, const Collection& collection) {
    int64_t whole = 0, part = 0, parts = 0;
    for (size_t i = 0; i < clips.size(); ++i) {
        const Query query{bench::markers_of(bench::at_another_pace(clips[i].clip, 11, i))};
        const auto found = collection.by_signature(query, 1);
        whole += !found.empty() && found.front().clip == int32_t(i) ? 1 : 0;
        const int64_t room = query.markers.rows() - query_frames;
        if (room < 0) continue;
        ++parts;
        const auto some =
            collection.by_signature({query.markers.middleRows(room / 2, query_frames)}, 1);
        part += !some.empty() && some.front().clip == int32_t(i) ? 1 : 0;
    }
    fmt::print(
        "at 0.7 to 1.4 times its pace, a take finds itself first: whole {:.3f}, 2 s of it "
        "{:.3f}\n",
        double(whole) / double(clips.size()), double(part) / double(parts));
}

void measure_growth(const Options& options, const std::vector<bench::NamedClip>& clips,
                    const std::vector<Query>& queries) {
    fmt::print("\n{:>9} {:>7} {:>8} {:>13} {:>11} {:>10}\n", "frames", "leaves", "runs",
               "signatures ms", "rerank ms", "warping ms");
    for (const int64_t frames : options.growth) {
        const std::vector<MarkerTake> takes = bench::varied_takes(clips, frames);
        const PoseHierarchy hierarchy =
            bench::hierarchy_of(takes, options.growth_tolerance, options.threads);
        const Collection collection(takes, hierarchy, options.threads);
        int64_t made = 0;
        for (const MarkerTake& take : takes) made += take.markers.rows();
        const std::vector<Query> few(
            queries.begin(), queries.begin() + std::min<int64_t>(12, int64_t(queries.size())));
        fmt::print("{:>9} {:>7} {:>8} {:>13.2f} {:>11.2f} {:>10.1f}\n", made, hierarchy.leaves(),
                   collection.runs(),
                   cost_of_search(collection, queries, &Collection::by_signature, 3),
                   cost_of_search(collection, queries, &Collection::by_signature_and_rerank, 3),
                   cost_of_search(collection, few, &Collection::by_warping, 1));
    }
}

void run(const Options& options) {
    const auto clips = bench::read_clips(options.corpus);
    std::vector<bench::NamedClip> kept;
    std::vector<MarkerTake> held_out;
    for (size_t i = 0; i < clips.size(); ++i) {
        if (i % 14 != 13) {
            kept.push_back(clips[i]);
        } else {
            held_out.push_back({clips[i].name, bench::markers_of(clips[i].clip)});
        }
    }
    const std::vector<MarkerTake> takes = bench::markers_of(kept);
    const PoseHierarchy hierarchy = bench::hierarchy_of(takes, options.tolerance, options.threads);
    const Collection collection(takes, hierarchy, options.threads);
    const std::vector<Query> queries = queries_of(held_out);
    fmt::print("{} takes, {} held out; {} leaves, {} runs; {} queries of 2 s\n\n", takes.size(),
               held_out.size(), hierarchy.leaves(), collection.runs(), queries.size());
    compare(collection, queries);
    fmt::print("\n");
    judge_pace(kept, collection);
    if (!options.truth.empty()) judge_annotated(options, bench::markers_of(clips), hierarchy);
    judge_generated(options);
    if (!options.growth.empty()) measure_growth(options, kept, queries);
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    bench::Program program(
        "How well and how fast does the signature index find what warping finds?");
    program.argument("corpus", options.corpus, "folder with NN/NN.asf and NN/NN_*.amc");
    program.argument("truth", options.truth, "CSV of its annotated activities",
                     bench::Program::Need::optional);
    program.option("--tolerance", options.tolerance, "of the leaves, mm per marker");
    program.option("--growth", options.growth, "sizes of collections of varied takes, frames");
    program.option("--growth-tolerance", options.growth_tolerance, "of their leaves");
    program.count("--threads", options.threads, "to grow hierarchies with");
    return program.run(argc, argv, [&] {
        run(options);
        return true;
    });
}
