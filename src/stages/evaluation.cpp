#include "kinetome/stages/evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/models/segmentation_controls.h"

namespace kinetome {
namespace {

std::map<std::string, std::vector<TruthRow>> rows_by_clip(std::span<const TruthRow> truth) {
    std::map<std::string, std::vector<TruthRow>> clips;
    for (const TruthRow& row : truth) clips[row.clip].push_back(row);
    return clips;
}

SegmentationScoreOptions score_options(const AnnotatedTake& take,
                                       const EvaluationOptions& options) {
    return {take.take.rate, options.boundary_tolerance};
}

int64_t annotated_activities(const AnnotatedTake& take) {
    return static_cast<int64_t>(take.truth.activities.size());
}

std::vector<NamedScore> score_controls(std::span<const AnnotatedTake> takes,
                                       const EvaluationOptions& options) {
    const auto cut_every = [&](double seconds) {
        return mean_score(
            takes,
            [seconds](const AnnotatedTake& take) {
                const auto length = std::max<int64_t>(1, std::llround(seconds * take.take.rate));
                return cuts_every(take.truth.frames(), length);
            },
            options);
    };
    const auto uniform = [](const AnnotatedTake& take) {
        return uniform_cuts(take.truth.frames(), annotated_activities(take));
    };
    std::vector<SegmentationScore> draws;
    for (int64_t draw = 0; draw < options.random_draws; ++draw) {
        RandomStream random(1, "random-cuts", static_cast<uint64_t>(draw));
        const auto at_random = [&random](const AnnotatedTake& take) {
            return random_cuts(take.truth.frames(), annotated_activities(take), random);
        };
        draws.push_back(mean_score(takes, at_random, options));
    }
    SegmentationScore random = average(draws);
    if (!draws.empty()) {
        const int64_t found = random.counts.boundaries_found / options.random_draws;
        random.counts = draws.front().counts;  // the same in every draw, but for …
        random.counts.boundaries_found = found;
    }
    const auto truth_itself = [](const AnnotatedTake& take) { return segments_of(take.truth); };
    return {{"a cut every second", cut_every(1)},
            {"a cut every 2 seconds", cut_every(2)},
            {"annotated number, uniform", mean_score(takes, uniform, options)},
            {"annotated number, random", random},
            {"annotation, no transitions", mean_score(takes, truth_itself, options)}};
}

std::vector<NamedScore> leave_one_out(const std::vector<NamedScore>& takes) {
    std::vector<NamedScore> means;
    for (size_t left_out = 0; takes.size() > 1 && left_out < takes.size(); ++left_out) {
        std::vector<SegmentationScore> others;
        for (size_t i = 0; i < takes.size(); ++i) {
            if (i != left_out) others.push_back(takes[i].score);
        }
        means.push_back({takes[left_out].name, average(others)});
    }
    return means;
}

/// Calls row(what, name, score) for every line of an evaluation.
template <class Row>
void for_each_score(const SegmentEvaluation& evaluation, const Row& row) {
    for (const auto& [clip, score] : evaluation.takes) row("take", clip, score);
    row("mean", "", evaluation.mean);
    for (const auto& [clip, score] : evaluation.without) row("mean without", clip, score);
    for (const auto& [name, score] : evaluation.beside) row("beside", name, score);
}

double transition_share(const SegmentationCounts& counts) {
    return counts.frames > 0 ? double(counts.transition_frames) / double(counts.frames) : 0;
}

}  // namespace

std::vector<AnnotatedTake> annotate(std::span<const SegmentedTake> takes,
                                    std::span<const TruthRow> truth,
                                    const std::string& truth_path) {
    std::vector<AnnotatedTake> annotated;
    for (const auto& [clip, rows] : rows_by_clip(truth)) {
        const auto take = std::find_if(takes.begin(), takes.end(),
                                       [&](const auto& one) { return one.clip == clip; });
        if (take == takes.end()) {
            throw InputError::at_line(truth_path, rows.front().line,
                                      "clip " + quote_for_message(clip) +
                                          " is annotated, but there are no segments of it: leave "
                                          "its rows out, or write its name as the clips have it");
        }
        annotated.push_back({*take, truth_timeline(rows, take->frames, take->rate, truth_path)});
    }
    return annotated;
}

std::vector<AnnotatedTake> annotated_alone(std::span<const TruthRow> truth,
                                           const std::string& truth_path, double rate) {
    std::vector<AnnotatedTake> annotated;
    for (const auto& [clip, rows] : rows_by_clip(truth)) {
        const int64_t frames = rows.back().end;
        annotated.push_back(
            {{clip, frames, rate, {}}, truth_timeline(rows, frames, rate, truth_path)});
    }
    return annotated;
}

SegmentationScore mean_score(std::span<const AnnotatedTake> takes,
                             const std::function<std::vector<Segment>(const AnnotatedTake&)>& cut,
                             const EvaluationOptions& options) {
    std::vector<SegmentationScore> scores;
    for (const AnnotatedTake& take : takes) {
        scores.push_back(score_segments(take.truth, cut(take), score_options(take, options)));
    }
    return average(scores);
}

SegmentEvaluation evaluate_segments(std::span<const AnnotatedTake> takes,
                                    const EvaluationOptions& options) {
    SegmentEvaluation evaluation;
    std::vector<SegmentationScore> scores;
    for (const AnnotatedTake& take : takes) {
        scores.push_back(
            score_segments(take.truth, take.take.segments, score_options(take, options)));
        evaluation.takes.push_back({take.take.clip, scores.back()});
    }
    evaluation.mean = average(scores);
    evaluation.without = leave_one_out(evaluation.takes);
    evaluation.beside = score_controls(takes, options);
    return evaluation;
}

Table evaluation_table(const SegmentEvaluation& evaluation) {
    Table table{{"what",
                 "name",
                 "strict",
                 "tolerant",
                 "lenient",
                 "purity",
                 "cluster_purity",
                 "hungarian",
                 "hungarian_without_zones",
                 "boundary_precision",
                 "boundary_recall",
                 "activities",
                 "annotated_activities",
                 "clusters",
                 "classes",
                 "transitions",
                 "transition_share",
                 "boundaries",
                 "annotated_boundaries",
                 "boundaries_found"},
                {}};
    for_each_score(evaluation,
                   [&](const char* what, const std::string& name, const SegmentationScore& score) {
                       const SegmentationCounts& counts = score.counts;
                       table.rows.push_back({what,
                                             name,
                                             score.strict,
                                             score.tolerant,
                                             score.lenient,
                                             score.purity,
                                             score.cluster_purity,
                                             score.hungarian,
                                             score.hungarian_without_zones,
                                             score.boundary_precision,
                                             score.boundary_recall,
                                             counts.activities,
                                             counts.true_activities,
                                             counts.clusters,
                                             counts.classes,
                                             counts.transitions,
                                             transition_share(counts),
                                             counts.boundaries,
                                             counts.true_boundaries,
                                             counts.boundaries_found});
                   });
    return table;
}

Table evaluation_summary(const SegmentEvaluation& evaluation) {
    Table table{
        {"", "strict", "tolerant", "purity", "of clusters", "Hungarian", "no zones", "boundary P",
         "boundary R", "found/set/true", "activities", "clusters", "transitions"},
        {}};
    const bool few_takes = evaluation.takes.size() <= 12;
    for_each_score(evaluation, [&](const std::string& what, const std::string& name,
                                   const SegmentationScore& score) {
        if (what == "mean without" && !few_takes) return;
        const std::string title = what == "mean without" ? what + " " + name
                                  : what == "mean"       ? what
                                                         : name;
        const SegmentationCounts& counts = score.counts;
        table.rows.push_back(
            {title, score.strict, score.tolerant, score.purity, score.cluster_purity,
             score.hungarian, score.hungarian_without_zones, score.boundary_precision,
             score.boundary_recall,
             fmt::format("{}/{}/{}", counts.boundaries_found, counts.boundaries,
                         counts.true_boundaries),
             fmt::format("{}/{}", counts.activities, counts.true_activities),
             fmt::format("{}/{}", counts.clusters, counts.classes),
             fmt::format("{} ({:.1f} %)", counts.transitions, 100 * transition_share(counts))});
    });
    return table;
}

}  // namespace kinetome
