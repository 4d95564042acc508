#include "kinetome/models/bundle_score.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "kinetome/base/random.h"
#include "kinetome/math/quantiles.h"

namespace kinetome {
namespace {

using ClassCounts = std::map<int32_t, int64_t>;

int64_t sum_of(const ClassCounts& counts) {
    int64_t sum = 0;
    for (const auto& [label, count] : counts) sum += count;
    return sum;
}

int64_t largest_of(const ClassCounts& counts) {
    int64_t most = 0;
    for (const auto& [label, count] : counts) most = std::max(most, count);
    return most;
}

double share(int64_t part, int64_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

double purity_of(std::span<const ClassCounts> classes_of_members,
                 std::span<const int32_t> bundle_of) {
    std::map<int32_t, ClassCounts> of_bundles;
    for (size_t i = 0; i < bundle_of.size(); ++i) {
        for (const auto& [label, count] : classes_of_members[i])
            of_bundles[bundle_of[i]][label] += count;
    }
    int64_t all = 0, pure = 0;
    for (const auto& [bundle, counts] : of_bundles) {
        all += sum_of(counts);
        pure += largest_of(counts);
    }
    return share(pure, all);
}

std::vector<int32_t> shuffled(std::vector<int32_t> values, uint64_t seed) {
    RandomStream random(seed, "shuffled bundles");
    for (size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[random.below(i)]);
    return values;
}

}  // namespace

BundleScore score_bundles(std::span<const MotionPiece> members, std::span<const int32_t> bundle_of,
                          std::span<const FrameClasses> classes, uint64_t seed) {
    if (members.size() != bundle_of.size())
        throw std::invalid_argument("each member needs the number of its bundle");
    std::vector<ClassCounts> classes_of_members;
    std::vector<int32_t> bundle_of_labelled;
    std::map<int32_t, std::vector<int64_t>> frames_of;  // members, by bundle
    int64_t covered = 0;
    for (size_t i = 0; i < members.size(); ++i) {
        const MotionPiece& member = members[i];
        if (member.clip < 0 || static_cast<size_t>(member.clip) >= classes.size())
            throw std::invalid_argument("a member is of a clip that is not there");
        const FrameClasses& labels = classes[static_cast<size_t>(member.clip)];
        if (labels.empty()) continue;
        if (member.first < 0 || member.end > static_cast<int64_t>(labels.size()))
            throw std::invalid_argument("a member reaches beyond its clip");
        ClassCounts counts;
        for (int64_t frame = member.first; frame < member.end; ++frame) {
            const int32_t label = labels[static_cast<size_t>(frame)];
            if (label != no_class) ++counts[label];
        }
        classes_of_members.push_back(std::move(counts));
        bundle_of_labelled.push_back(bundle_of[i]);
        frames_of[bundle_of[i]].push_back(member.frames());
        covered += member.frames();
    }

    BundleScore score;
    score.purity = purity_of(classes_of_members, bundle_of_labelled);
    score.shuffled = purity_of(classes_of_members, shuffled(bundle_of_labelled, seed));
    ClassCounts all;
    int64_t frames = 0;
    for (const FrameClasses& labels : classes) {
        frames += static_cast<int64_t>(labels.size());
        for (const int32_t label : labels) {
            if (label != no_class) ++all[label];
        }
    }
    score.chance = share(largest_of(all), sum_of(all));
    score.coverage = share(covered, frames);
    score.bundles = static_cast<int64_t>(frames_of.size());
    if (frames_of.empty()) return score;
    score.mean_height = share(static_cast<int64_t>(bundle_of_labelled.size()), score.bundles);
    std::vector<double> widths;
    for (const auto& [bundle, lengths] : frames_of) {
        int64_t sum = 0;
        for (const int64_t length : lengths) sum += length;
        widths.push_back(share(sum, static_cast<int64_t>(lengths.size())));
    }
    score.median_width = upper_median(std::move(widths));
    return score;
}

}  // namespace kinetome
