#include "kinetome/models/bundle_members.h"

#include <algorithm>
#include <cmath>

#include "kinetome/models/similar_substrings.h"

namespace kinetome {

double bundle_volume(int64_t height, double width, double rho) {
    return static_cast<double>(height - 1) * std::pow(width, rho);
}

MemberChoice::MemberChoice(const MotionString& string) : string_(string), used_(string.size()) {}

void MemberChoice::consider(std::span<const Substring> similar) {
    candidates_.clear();
    for (const Substring& substring : similar) {
        candidates_.push_back({half_frames(string_, substring), substring});
    }
    std::ranges::sort(candidates_);
}

void MemberChoice::take(const Candidate& candidate) {
    if (used_.contains_any(candidate.substring)) return;
    used_.insert(candidate.substring);
    taken_.push_back(candidate);
}

BundleMembers MemberChoice::choose(const Substring& reference, double gamma) {
    const int64_t wanted = half_frames(string_, reference);
    take({wanted, reference});
    take_nearest(wanted);
    return taken_within(gamma);
}

BundleMembers MemberChoice::choose_by_mean(double gamma) {
    const auto count = static_cast<int64_t>(candidates_.size());
    int64_t sum = 0;
    for (const Candidate& candidate : candidates_) sum += candidate.half_frames;
    take_nearest((2 * sum + count) / (2 * count));
    return taken_within(gamma);
}

void MemberChoice::take_nearest(int64_t wanted) {
    // Candidates are sorted by length: runs of equal ones are met from that length on, going to
    // both sides by whichever ratio is nearer to 1.
    const auto run_begin = [&](size_t i) {
        while (i > 0 && candidates_[i - 1].half_frames == candidates_[i].half_frames) --i;
        return i;
    };
    const auto middle = std::ranges::lower_bound(candidates_, wanted, {}, &Candidate::half_frames);
    auto shorter_end = static_cast<size_t>(middle - candidates_.begin());
    size_t longer = shorter_end;
    while (shorter_end > 0 || longer < candidates_.size()) {
        // wanted / shorter <= longer / wanted
        const bool shorter_first =
            shorter_end > 0 && (longer == candidates_.size() ||
                                wanted * wanted <= candidates_[longer].half_frames *
                                                       candidates_[shorter_end - 1].half_frames);
        if (shorter_first) {
            const size_t begin = run_begin(shorter_end - 1);
            for (size_t i = begin; i < shorter_end; ++i) take(candidates_[i]);
            shorter_end = begin;
        } else {
            take(candidates_[longer++]);
        }
    }
}

BundleMembers MemberChoice::taken_within(double gamma) {
    int64_t sum = 0;
    for (const Candidate& candidate : taken_) {
        used_.erase(candidate.substring);
        sum += candidate.half_frames;
    }
    const double mean = static_cast<double>(sum) / static_cast<double>(taken_.size());

    BundleMembers bundle;
    int64_t kept = 0;
    for (const Candidate& candidate : taken_) {
        const auto length = static_cast<double>(candidate.half_frames);
        if (length < gamma * mean || gamma * length > mean) continue;
        bundle.members.push_back(candidate.substring);
        kept += candidate.half_frames;
    }
    taken_.clear();
    std::ranges::sort(bundle.members);
    if (!bundle.members.empty())
        bundle.mean_frames =
            static_cast<double>(kept) / 2 / static_cast<double>(bundle.members.size());
    return bundle;
}

}  // namespace kinetome
