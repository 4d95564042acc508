#include "signature_places.h"

#include <algorithm>

namespace kinetome {
namespace {

/// Clips cut into bins of equal width, numbered over all clips; what was said of each.
class Votes {
  public:
    Votes(const ValueLists<SignatureRun>& clips, int64_t width) : clips_(clips), width_(width) {
        first_bin_.reserve(static_cast<size_t>(clips.size() + 1));
        int64_t bins = 0;
        for (int64_t clip = 0; clip < clips.size(); ++clip) {
            first_bin_.push_back(bins);
            bins += frame_count(clips[clip]) / width + 1;
        }
        first_bin_.push_back(bins);
        sums_.resize(static_cast<size_t>(bins), 0);
        last_voter_.resize(static_cast<size_t>(bins), -1);
    }

    /// For the middle of the query lying in [first, last] of a clip, or within one bin of it. A
    /// voter's first vote for a bin counts.
    void vote(int32_t voter, int64_t clip, int64_t first, int64_t last, float weight) {
        const int64_t begin = first_bin_[static_cast<size_t>(clip)];
        const int64_t bins = first_bin_[static_cast<size_t>(clip) + 1] - begin;
        const int64_t low = std::max<int64_t>(first / width_ - 1, 0);
        const int64_t high = std::min<int64_t>(last / width_ + 1, bins - 1);
        for (int64_t bin = begin + low; bin <= begin + high; ++bin) {
            int32_t& last_voter = last_voter_[static_cast<size_t>(bin)];
            if (last_voter == voter) continue;
            if (last_voter < 0) voted_.push_back(bin);
            last_voter = voter;
            sums_[static_cast<size_t>(bin)] += weight;
        }
    }

    /// The middles of the bins with most votes, neighbours of better ones left out.
    std::vector<SignaturePlace> winners(int64_t count, int64_t half_length) {
        const auto worse = [&](int64_t a, int64_t b) {
            const float sum_a = sums_[static_cast<size_t>(a)],
                        sum_b = sums_[static_cast<size_t>(b)];
            return sum_a != sum_b ? sum_a < sum_b : a > b;
        };
        std::ranges::make_heap(voted_, worse);
        std::vector<SignaturePlace> places;
        while (!voted_.empty() && static_cast<int64_t>(places.size()) < count) {
            std::ranges::pop_heap(voted_, worse);
            const int64_t bin = voted_.back();
            voted_.pop_back();
            if (last_voter_[static_cast<size_t>(bin)] == beside_winner) continue;
            places.push_back(place_of(bin, half_length));
            for (int64_t near = bin - 1; near <= bin + 1; ++near) leave_out(near);
        }
        return places;
    }

  private:
    static constexpr int32_t beside_winner = -2;

    void leave_out(int64_t bin) {
        if (bin < 0 || bin >= first_bin_.back()) return;
        last_voter_[static_cast<size_t>(bin)] = beside_winner;
    }

    SignaturePlace place_of(int64_t bin, int64_t half_length) const {
        const auto after = std::ranges::upper_bound(first_bin_, bin);
        const auto clip = static_cast<int32_t>(after - first_bin_.begin() - 1);
        const int64_t middle = (bin - first_bin_[static_cast<size_t>(clip)]) * width_ + width_ / 2;
        return {clip,
                {std::max<int64_t>(middle - half_length, 0),
                 std::min<int64_t>(middle + half_length, frame_count(clips_[clip]))}};
    }

    const ValueLists<SignatureRun>& clips_;
    int64_t width_;
    std::vector<int64_t> first_bin_;  ///< by clip, and one beyond
    std::vector<float> sums_;
    std::vector<int32_t> last_voter_;
    std::vector<int64_t> voted_;  ///< bins that anything was said of
};

/// Those of at most `count`, evenly spaced.
template <class Visit>
void visit_evenly(std::span<const int32_t> values, int64_t count, const Visit& visit) {
    const auto size = static_cast<int64_t>(values.size());
    const int64_t visited = std::min(size, count);
    for (int64_t i = 0; i < visited; ++i) visit(values[static_cast<size_t>(i * size / visited)]);
}

}  // namespace

std::vector<SignaturePlace> likely_places(const SignatureIndex::Parts& parts,
                                          std::span<const int32_t> clip_of_run,
                                          std::span<const SignatureRun> query,
                                          const SignatureSearchOptions& options) {
    const int64_t length = frame_count(query);
    Votes votes(parts.clips, std::max<int64_t>(length / 4, 1));
    for (size_t i = 0; i < query.size(); ++i) {
        const int64_t run_first = query[i].first_frame - length / 2;
        const int64_t run_end = run_first + query[i].frames;
        int64_t left = options.occurrences;
        for (const NearLeaf& near : parts.near_leaves[query[i].leaf]) {
            const auto weight = float(query[i].frames * (1 - double(near.distance) / parts.reach));
            const auto occurrences = parts.occurrences[near.leaf];
            visit_evenly(occurrences, left, [&](int32_t run) {
                const SignatureRun& answer = parts.clips.values[static_cast<size_t>(run)];
                // One run lies inside the other, wherever between these two the query lies.
                const int64_t starts_agree = answer.first_frame - run_first;
                const int64_t ends_agree = answer.end_frame() - run_end;
                votes.vote(static_cast<int32_t>(i), clip_of_run[static_cast<size_t>(run)],
                           std::min(starts_agree, ends_agree), std::max(starts_agree, ends_agree),
                           weight);
            });
            left -= static_cast<int64_t>(occurrences.size());
            if (left <= 0) break;
        }
    }
    return votes.winners(options.places, length);
}

}  // namespace kinetome
