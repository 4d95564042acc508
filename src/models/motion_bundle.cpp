#include "kinetome/models/motion_bundle.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "kinetome/models/bundle_members.h"
#include "kinetome/models/bundle_seeds.h"
#include "kinetome/models/similar_substrings.h"

namespace kinetome {
namespace {

IntervalSet intervals_inside_clips(const MotionString& string) {
    IntervalSet open(string.size());
    for (int32_t j = 0; j < string.size(); ++j) {
        if (!string.breaks_after(j)) open.insert({j, j + 1});
    }
    return open;
}

void check(const MotionBundleOptions& options, int64_t longest) {
    if (longest < 2) throw std::invalid_argument("substrings must have two letters or more");
    if (!(options.gamma >= 0 && options.gamma <= 1))
        throw std::invalid_argument("gamma must be between 0 and 1");
    if (!(options.rho > 0)) throw std::invalid_argument("rho must be positive");
    if (options.depth < 1) throw std::invalid_argument("the depth of a spread must be 1 or more");
}

/// The rounds of S1 §3.3; Words × 64 letters are enough for any member.
template <int Words>
class BundleFinder {
  public:
    BundleFinder(const MotionString& string, const AccessibilityMatrix& accessibility,
                 int64_t longest, const MotionBundleOptions& options,
                 const BundleResources& resources)
        : string_(string),
          options_(options),
          longest_(static_cast<int32_t>(std::min(longest, most_matched_letters))),
          open_(intervals_inside_clips(string)),
          index_(string, accessibility),
          context_{string, accessibility, index_, open_,
                   static_cast<int32_t>(std::min(2 * longest, most_matched_letters))},
          seeds_(string, accessibility.letters(), index_, open_, options.seed),
          similar_(context_, options, resources),
          choice_(string) {}

    std::vector<SubstringBundle> find() {
        std::vector<SubstringBundle> bundles, degenerate;
        while (const auto seed = seeds_.next()) {
            SubstringBundle bundle{largest_bundle(*seed)};
            if (bundle.members.empty()) bundle.members = {shortest_at(*seed)};
            for (const Substring& member : bundle.members) {
                open_.erase(member);
                seeds_.closed(member);
            }
            (bundle.is_degenerate() ? degenerate : bundles).push_back(std::move(bundle));
        }
        for (SubstringBundle& bundle : merged(degenerate)) bundles.push_back(std::move(bundle));
        return bundles;
    }

  private:
    struct Best {
        double volume = 0;
        Substring reference;
        std::vector<Substring> members;
    };

    /// Every open substring that holds the letter and is no longer than λ, in order.
    std::vector<Substring> windows(int32_t seed) const {
        const int32_t first = seed - open_.run_before(seed, longest_ - 1);
        const int32_t last = seed + open_.run_after(seed, longest_ - 1);
        std::vector<Substring> all;
        for (int32_t j = first; j <= seed; ++j) {
            for (int32_t e = std::max(seed, j + 1); e <= std::min(last, j + longest_ - 1); ++e) {
                all.push_back({j, e});
            }
        }
        return all;
    }

    /// Members of the bundle of largest volume that any of the seed's windows leads to, ties to the
    /// first window; none when all would be degenerate.
    std::vector<Substring> largest_bundle(int32_t seed) {
        const std::vector<Substring> all = windows(seed);
        similar_.prepare(all);
        Best best;
        std::vector<bool> done(all.size());
        for (size_t w = 0; w < all.size(); ++w) {
            if (done[w]) continue;
            const std::vector<Substring> similar = similar_.find(all[w]);
            if (similar.size() < 2) continue;
            choice_.consider(similar);
            const std::vector<Substring> equivalent = references(all[w], similar, seed);
            for (const Substring& one : equivalent)
                done[static_cast<size_t>(std::ranges::lower_bound(all, one) - all.begin())] = true;
            if (options_.member_length == MemberLength::mean) {
                improve(best, all[w], choice_.choose_by_mean(options_.gamma));
                continue;
            }
            for (const Substring& reference : equivalent)
                improve(best, reference, choice_.choose(reference, options_.gamma));
        }
        return std::move(best.members);
    }

    /// The windows that the same substrings are similar to: all those among them if the relation is
    /// an equivalence, else the one it was spread from.
    std::vector<Substring> references(const Substring& window,
                                      const std::vector<Substring>& similar, int32_t seed) const {
        if (options_.spread != BundleSpread::closure &&
            options_.spread != BundleSpread::closure_near) {
            return {window};
        }
        std::vector<Substring> found;
        for (const Substring& one : similar) {
            if (one.first <= seed && seed <= one.last && one.letters() <= longest_)
                found.push_back(one);
        }
        return found;
    }

    void improve(Best& best, const Substring& reference, BundleMembers bundle) const {
        const auto height = static_cast<int64_t>(bundle.members.size());
        if (height < 2) return;
        const double volume = bundle_volume(height, bundle.mean_frames, options_.rho);
        if (best.members.empty() || volume > best.volume ||
            (volume == best.volume && reference < best.reference)) {
            best = {volume, reference, std::move(bundle.members)};
        }
    }

    /// Of the two letters' substrings that hold the letter the one with fewest frames, ties to the
    /// first.
    Substring shortest_at(int32_t seed) const {
        const Substring before{seed - 1, seed}, after{seed, seed + 1};
        if (open_.run_before(seed, 1) == 0) return after;
        if (open_.run_after(seed, 1) == 0) return before;
        return half_frames(string_, after) < half_frames(string_, before) ? after : before;
    }

    static std::vector<SubstringBundle> merged(std::vector<SubstringBundle>& degenerate) {
        std::ranges::sort(degenerate, {}, [](const SubstringBundle& bundle) {
            return bundle.members.front().first;
        });
        std::vector<SubstringBundle> all;
        for (const SubstringBundle& bundle : degenerate) {
            const Substring& member = bundle.members.front();
            if (!all.empty() && all.back().members.front().last == member.first) {
                all.back().members.front().last = member.last;
            } else {
                all.push_back(bundle);
            }
        }
        return all;
    }

    const MotionString& string_;
    const MotionBundleOptions options_;
    const int32_t longest_;
    IntervalSet open_;
    const LetterIndex index_;
    const MatchingContext context_;
    BundleSeeds seeds_;
    SimilarSubstrings<Words> similar_;
    MemberChoice choice_;
};

}  // namespace

std::vector<SubstringBundle> find_motion_bundles(const MotionString& string,
                                                 const AccessibilityMatrix& accessibility,
                                                 int64_t longest,
                                                 const MotionBundleOptions& options,
                                                 const BundleResources& resources) {
    check(options, longest);
    const auto find = [&]<int Words>() {
        return BundleFinder<Words>(string, accessibility, longest, options, resources).find();
    };
    if (2 * longest <= ReachMask<1>::bits) return find.template operator()<1>();
    if (2 * longest <= ReachMask<2>::bits) return find.template operator()<2>();
    if (2 * longest <= ReachMask<4>::bits) return find.template operator()<4>();
    return find.template operator()<8>();
}

}  // namespace kinetome
