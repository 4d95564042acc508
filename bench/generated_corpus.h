// A procedural corpus in memory, with the truth about it: shared by the benchmarks of bundles.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "activity_blends.h"
#include "kinetome/base/parallel.h"
#include "kinetome/models/bundle_score.h"
#include "kinetome/models/truth_timeline.h"
#include "kinetome/synthesis/corpus_generator.h"
#include "kinetome/synthesis/take.h"

namespace kinetome::bench {

/// As `kinetome generate` makes it, but for the rounding of its files.
struct GeneratedCorpus {
    std::vector<TakePlan> plans;
    std::vector<Clip> clips;
    std::vector<std::string> labels;    ///< by class
    std::vector<FrameClasses> classes;  ///< by take
    std::vector<FrameClasses> blends;   ///< by take: blended_with

    GeneratedCorpus(int64_t frames, int64_t subjects, uint64_t seed, int threads) {
        const std::vector<int64_t> lengths = take_lengths(frames, seed);
        const auto takes = static_cast<int64_t>(lengths.size());
        const int64_t performers = subject_count(takes, subjects);
        std::map<int64_t, int64_t> takes_of;
        for (int64_t take = 0; take < takes; ++take) {
            const int64_t subject = subject_of_take(take, takes, performers);
            plans.push_back(
                plan_take(take, lengths[size_t(take)], subject, ++takes_of[subject], seed));
        }
        clips.resize(plans.size());
        parallel_for(threads, takes, [&](int64_t take) {
            const TakePlan& plan = plans[size_t(take)];
            clips[size_t(take)] = perform(plan, make_subject(plan.subject, seed), seed);
        });
        std::map<std::string, int32_t> numbers;
        for (const TakePlan& plan : plans) {
            auto& of_take = classes.emplace_back(size_t(plan.frames), no_class);
            const std::vector<TruthRow> truth = annotate(plan).truth;
            for (const TruthRow& row : truth) {
                const auto [label, is_new] = numbers.emplace(row.label, int32_t(labels.size()));
                if (is_new) labels.push_back(row.label);
                std::fill(of_take.begin() + row.first, of_take.begin() + row.end, label->second);
            }
            blends.push_back(
                blended_with(truth_timeline(truth, plan.frames, synthesis_rate, plan.name()),
                             plan.frames, numbers));
        }
    }

    int64_t frames() const {
        int64_t sum = 0;
        for (const TakePlan& plan : plans) sum += plan.frames;
        return sum;
    }
    std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const TakePlan& plan : plans) all.push_back(plan.name());
        return all;
    }
};

}  // namespace kinetome::bench
