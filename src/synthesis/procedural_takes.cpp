#include <cmath>
#include <vector>

#include "kinetome/synthesis/take.h"
#include "take_maker.h"

namespace kinetome {
namespace {

class ProceduralTakes : public TakeMaker {
  public:
    explicit ProceduralTakes(const GenerateOptions& options)
        : seed_(options.seed),
          lengths_(take_lengths(options.frames, options.seed)),
          subjects_(subject_count(takes(), options.subjects)) {}

    int64_t takes() const override { return static_cast<int64_t>(lengths_.size()); }
    int64_t subjects() const override { return subjects_; }

    NewTake make(int64_t index) const override {
        const int64_t subject = subject_of_take(index, takes(), subjects_);
        int64_t first = index;
        while (first > 0 && subject_of_take(first - 1, takes(), subjects_) == subject) --first;
        const TakePlan plan = plan_take(index, lengths_[static_cast<size_t>(index)], subject,
                                        index - first + 1, seed_);
        return {.subject = plan.subject_name(),
                .name = plan.name(),
                .first_of_subject = index == first,
                .clip = perform(plan, make_subject(subject, seed_), seed_),
                .annotations = annotate(plan)};
    }

  private:
    uint64_t seed_;
    std::vector<int64_t> lengths_;
    int64_t subjects_;
};

}  // namespace

std::unique_ptr<TakeMaker> procedural_takes(const GenerateOptions& options) {
    return std::make_unique<ProceduralTakes>(options);
}

Annotations annotate(const TakePlan& plan) {
    Annotations annotations;
    for (const SegmentPlan& segment : plan.segments) {
        const std::string label(activity_name(segment.label()));
        annotations.truth.push_back({.clip = plan.name(),
                                     .first = segment.first,
                                     .end = segment.end,
                                     .label = label,
                                     .end_lo = segment.blend_first,
                                     .end_hi = segment.blend_end});
        if (!is_cyclic(segment.activity)) continue;
        for (const CyclePlan& cycle : segment.cycles) {
            const int64_t first = std::llround(cycle.first);
            const int64_t end = std::llround(cycle.first + cycle.frames);
            if (end > segment.end) break;
            annotations.cycles.push_back({plan.name(), first, end, label});
        }
    }
    return annotations;
}

}  // namespace kinetome
