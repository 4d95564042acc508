#include "kinetome/stages/primitive_evaluation.h"

#include <algorithm>
#include <map>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"

namespace kinetome {
namespace {

std::map<std::string, std::vector<RowRange>> cycles_by_clip(std::span<const AnnotatedTake> takes,
                                                            std::span<const CycleRow> cycles,
                                                            const std::string& path) {
    std::map<std::string, std::vector<RowRange>> clips;
    for (const CycleRow& cycle : cycles) {
        const auto refuse = [&](const std::string& reason) {
            throw InputError::at_line(path, cycle.line,
                                      "clip " + quote_for_message(cycle.clip) + " " + reason);
        };
        const auto take = std::find_if(takes.begin(), takes.end(), [&](const auto& one) {
            return one.take.clip == cycle.clip;
        });
        if (take == takes.end()) refuse("has cycles, but its activities are not annotated");
        if (cycle.end <= cycle.first) refuse("has a cycle without frames");
        if (cycle.end > take->truth.frames()) {
            refuse("has a cycle until frame " + std::to_string(cycle.end) + ", but " +
                   std::to_string(take->truth.frames()) + " frames");
        }
        clips[cycle.clip].push_back({cycle.first, cycle.end});
    }
    return clips;
}

/// Those of the take; they must not leave it.
PrimitivesOfTake primitives_of(const AnnotatedTake& take,
                               std::span<const PrimitivesOfTake> primitives,
                               const std::string& path) {
    for (const PrimitivesOfTake& one : primitives) {
        if (one.clip != take.take.clip) continue;
        if (!one.primitives.empty() && one.primitives.back().end > take.truth.frames()) {
            throw InputError::in_file(
                path, "clip " + quote_for_message(one.clip) + " has a primitive until frame " +
                          std::to_string(one.primitives.back().end) + ", but " +
                          std::to_string(take.truth.frames()) + " frames");
        }
        return one;
    }
    return {take.take.clip, {}, {}};
}

/// Clusters and classes of all takes, classes numbered alike in all.
class SharedPurity {
  public:
    void add(const TruthTimeline& truth, const PrimitivesOfTake& of_take) {
        clusters_.insert(clusters_.end(), of_take.clusters.begin(), of_take.clusters.end());
        for (const int32_t its_class : classes_of_primitives(truth, of_take.primitives)) {
            classes_.push_back(its_class < 0 ? -1 : number(truth.classes[size_t(its_class)]));
        }
    }
    int64_t pure() const { return pure_members(clusters_, classes_); }

  private:
    int32_t number(const std::string& label) {
        return numbers_.try_emplace(label, static_cast<int32_t>(numbers_.size())).first->second;
    }
    std::map<std::string, int32_t> numbers_;
    std::vector<int32_t> clusters_, classes_;
};

}  // namespace

PrimitiveEvaluation evaluate_primitives(std::span<const AnnotatedTake> takes,
                                        std::span<const PrimitivesOfTake> primitives,
                                        const std::string& primitives_path,
                                        std::span<const CycleRow> cycles,
                                        const std::string& cycles_path) {
    auto cycles_of = cycles_by_clip(takes, cycles, cycles_path);
    PrimitiveEvaluation evaluation;
    SharedPurity purity;
    for (const AnnotatedTake& take : takes) {
        const PrimitivesOfTake of_take = primitives_of(take, primitives, primitives_path);
        const PrimitiveScore score = score_primitives(take.truth, cycles_of[take.take.clip],
                                                      of_take.primitives, of_take.clusters);
        evaluation.takes.push_back({take.take.clip, score});
        evaluation.total += score;
        purity.add(take.truth, of_take);
    }
    evaluation.total.pure = purity.pure();
    return evaluation;
}

Table evaluation_table(const PrimitiveEvaluation& evaluation) {
    Table table{{"what", "name", "primitives", "cycles", "activities", "counted_exactly",
                 "counted_within_one", "cluster_purity"},
                {}};
    const auto share = [](double of, int64_t whole) {  // of nothing there is none
        return whole > 0 ? Table::Cell(of) : Table::Cell(std::string());
    };
    const auto row = [&](const char* what, const std::string& name, const PrimitiveScore& score) {
        table.rows.push_back({what, name, score.primitives, score.cycles, score.activities,
                              share(score.exact_share(), score.activities),
                              share(score.within_one_share(), score.activities),
                              share(score.purity(), score.classified)});
    };
    for (const auto& [clip, score] : evaluation.takes) row("take", clip, score);
    row("total", "", evaluation.total);
    return table;
}

}  // namespace kinetome
