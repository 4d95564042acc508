#include "kinetome/models/primitive_score.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <stdexcept>

namespace kinetome {
namespace {

double share(int64_t part, int64_t whole) {
    return whole > 0 ? double(part) / double(whole) : 0.0;
}

/// Ranges whose middle lies in each activity.
std::vector<int64_t> count_by_activity(const TruthTimeline& truth,
                                       std::span<const RowRange> ranges) {
    std::vector<int64_t> counts(truth.activities.size(), 0);
    for (const RowRange& range : ranges) {
        const int64_t middle = range.first + range.size() / 2;
        for (size_t a = 0; a < counts.size(); ++a) {
            const RowRange& frames = truth.activities[a].frames;
            counts[a] += frames.first <= middle && middle < frames.end;
        }
    }
    return counts;
}

}  // namespace

double PrimitiveScore::exact_share() const {
    return share(exact, activities);
}
double PrimitiveScore::within_one_share() const {
    return share(within_one, activities);
}
double PrimitiveScore::purity() const {
    return share(pure, classified);
}

PrimitiveScore& PrimitiveScore::operator+=(const PrimitiveScore& other) {
    primitives += other.primitives;
    cycles += other.cycles;
    activities += other.activities;
    exact += other.exact;
    within_one += other.within_one;
    classified += other.classified;
    pure += other.pure;
    return *this;
}

std::vector<int32_t> classes_of_primitives(const TruthTimeline& truth,
                                           std::span<const RowRange> primitives) {
    const std::vector<int32_t> labels = truth.class_of_frames();
    const std::vector<char> uncertain = truth.uncertain_frames();
    std::vector<int32_t> classes;
    for (const RowRange& primitive : primitives) {
        if (primitive.first < 0 || primitive.end > truth.frames()) {
            throw std::invalid_argument("a primitive leaves its take");
        }
        std::vector<int64_t> frames(truth.classes.size(), 0);
        for (auto f = static_cast<size_t>(primitive.first); f < size_t(primitive.end); ++f) {
            if (!uncertain[f]) ++frames[static_cast<size_t>(labels[f])];
        }
        const auto most = std::max_element(frames.begin(), frames.end());
        const bool has_class = most != frames.end() && *most > 0;
        classes.push_back(has_class ? static_cast<int32_t>(most - frames.begin()) : -1);
    }
    return classes;
}

int64_t pure_members(std::span<const int32_t> clusters, std::span<const int32_t> classes) {
    if (clusters.size() != classes.size()) {
        throw std::invalid_argument("not every member has a cluster and a class");
    }
    std::map<int32_t, std::map<int32_t, int64_t>> members;
    for (size_t p = 0; p < clusters.size(); ++p) {
        if (classes[p] >= 0) ++members[clusters[p]][classes[p]];
    }
    int64_t pure = 0;
    for (const auto& [cluster, by_class] : members) {
        int64_t most = 0;
        for (const auto& [its_class, count] : by_class) most = std::max(most, count);
        pure += most;
    }
    return pure;
}

PrimitiveScore score_primitives(const TruthTimeline& truth, std::span<const RowRange> cycles,
                                std::span<const RowRange> primitives,
                                std::span<const int32_t> clusters) {
    PrimitiveScore score;
    score.primitives = static_cast<int64_t>(primitives.size());
    score.cycles = static_cast<int64_t>(cycles.size());
    const std::vector<int64_t> annotated = count_by_activity(truth, cycles);
    const std::vector<int64_t> found = count_by_activity(truth, primitives);
    for (size_t a = 0; a < annotated.size(); ++a) {
        if (annotated[a] == 0) continue;
        ++score.activities;
        score.exact += found[a] == annotated[a];
        score.within_one += std::abs(found[a] - annotated[a]) <= 1;
    }
    const std::vector<int32_t> classes = classes_of_primitives(truth, primitives);
    score.classified =
        std::count_if(classes.begin(), classes.end(), [](int32_t c) { return c >= 0; });
    score.pure = pure_members(clusters, classes);
    return score;
}

}  // namespace kinetome
