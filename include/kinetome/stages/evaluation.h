// Segments of takes against their annotation (`evaluate --what segments`).
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "kinetome/models/segmentation_score.h"
#include "kinetome/models/truth_timeline.h"
#include "kinetome/stages/export.h"
#include "kinetome/stages/segment_table.h"

namespace kinetome {

struct EvaluationOptions {
    double boundary_tolerance = 0.5;  ///< seconds by which a boundary may miss a zone
    int64_t random_draws = 50;        ///< of the control that cuts at random
};

/// A take with its annotation; frames at the source's rate.
struct AnnotatedTake {
    SegmentedTake take;
    TruthTimeline truth;
};

/// The takes that `truth` annotates, by name. Throws InputError naming `truth_path` and a line when
/// a clip that has rows is not among `takes`, and what truth_timeline throws.
std::vector<AnnotatedTake> annotate(std::span<const SegmentedTake> takes,
                                    std::span<const TruthRow> truth, const std::string& truth_path);

/// Takes without segments, as long as their annotation. Throws as annotate does.
std::vector<AnnotatedTake> annotated_alone(std::span<const TruthRow> truth,
                                           const std::string& truth_path, double rate);

struct NamedScore {
    std::string name;
    SegmentationScore score;
};

struct SegmentEvaluation {
    std::vector<NamedScore> takes;  ///< by name
    SegmentationScore mean;
    std::vector<NamedScore> without;  ///< the mean of all takes but the one named; of two or more
    std::vector<NamedScore> beside;   ///< means of what the motion was not asked for, and of peers
};

SegmentEvaluation evaluate_segments(std::span<const AnnotatedTake> takes,
                                    const EvaluationOptions& options = {});

/// The mean score of what `cut` makes of each take.
SegmentationScore mean_score(std::span<const AnnotatedTake> takes,
                             const std::function<std::vector<Segment>(const AnnotatedTake&)>& cut,
                             const EvaluationOptions& options = {});

/// what,name and one column a figure; what is take, mean, mean without or beside.
Table evaluation_table(const SegmentEvaluation& evaluation);

/// The same to be read: found and annotated numbers side by side; means without single takes only
/// where there are few takes.
Table evaluation_summary(const SegmentEvaluation& evaluation);

}  // namespace kinetome
