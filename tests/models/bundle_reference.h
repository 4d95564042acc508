// Motion bundles as S1 §3.3 words them, with no thought for time: what the fast search must equal.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "kinetome/base/random.h"
#include "kinetome/models/motion_bundle.h"

namespace reference {

using kinetome::AccessibilityMatrix;
using kinetome::BundleSpread;
using kinetome::MotionBundleOptions;
using kinetome::MotionString;
using kinetome::Substring;
using kinetome::SubstringBundle;

class Search {
  public:
    Search(const MotionString& string, const AccessibilityMatrix& accessibility, int64_t longest,
           const MotionBundleOptions& options)
        : s_(string), a_(accessibility), longest_(longest), options_(options) {
        for (int64_t j = 0; j < s_.size(); ++j) p_.push_back(s_.breaks_after(j));
    }

    std::vector<SubstringBundle> run() {
        std::vector<SubstringBundle> bundles, degenerate;
        for (int32_t c = seed(); c >= 0; c = seed()) {
            SubstringBundle bundle = largest(c);
            for (const Substring& member : bundle.members) {
                for (int32_t j = member.first; j < member.last; ++j) p_[at(j)] = true;
            }
            (bundle.is_degenerate() ? degenerate : bundles).push_back(bundle);
        }
        std::map<int32_t, int32_t> last_of;  // degenerate substrings by their first letters
        for (const auto& bundle : degenerate)
            last_of[bundle.members[0].first] = bundle.members[0].last;
        while (!last_of.empty()) {
            const auto [first, last] = *last_of.begin();
            last_of.erase(first);
            if (last_of.contains(last)) {
                last_of[first] = last_of[last];
                last_of.erase(last);
            } else {
                bundles.push_back({{{first, last}}});
            }
        }
        return bundles;
    }

  private:
    static size_t at(int32_t j) { return static_cast<size_t>(j); }
    int32_t size() const { return static_cast<int32_t>(s_.size()); }
    bool partitioned(int32_t interval) const {
        return interval < 0 || interval >= size() || p_[at(interval)];
    }
    bool open(const Substring& ss) const {
        for (int32_t j = ss.first; j < ss.last; ++j) {
            if (partitioned(j)) return false;
        }
        return true;
    }
    double frames(const Substring& ss) const {
        return s_.mean_frame(ss.last) - s_.mean_frame(ss.first);
    }

    bool agree(double length, double mean) const {
        return length >= options_.gamma * mean && options_.gamma * length <= mean;
    }

    int32_t seed() const {
        std::map<int32_t, std::vector<int32_t>> instances;
        for (int32_t j = 0; j < size(); ++j) {
            if (!partitioned(j - 1) || !partitioned(j)) instances[s_.letters[at(j)]].push_back(j);
        }
        int32_t best = -1;
        for (const auto& [letter, all] : instances) {
            if (best < 0 || all.size() > instances[best].size()) best = letter;
        }
        if (best < 0) return -1;
        const auto& all = instances[best];
        kinetome::RandomStream random(options_.seed, "motion bundle",
                                      (uint64_t(best) << 32U) + all.size());
        return all[random.below(all.size())];
    }

    /// Every open substring of 2 to 2 λ letters.
    std::vector<Substring> substrings(int64_t most) const {
        std::vector<Substring> all;
        for (int32_t j = 0; j < size(); ++j) {
            for (int32_t e = j + 1; e < size() && e - j < most && open({j, e}); ++e)
                all.push_back({j, e});
        }
        return all;
    }

    /// A valid path through SSA (Eq. 4).
    bool match(const Substring& x, const Substring& y) const {
        const int32_t rows = x.letters(), columns = y.letters();
        std::vector<std::vector<bool>> reached(at(rows), std::vector<bool>(at(columns)));
        for (int32_t i = 0; i < rows; ++i) {
            for (int32_t j = 0; j < columns; ++j) {
                bool from = i == 0 && j == 0;
                if (i > 0) from = from || reached[at(i - 1)][at(j)];
                if (j > 0) from = from || reached[at(i)][at(j - 1)];
                if (i > 0 && j > 0) from = from || reached[at(i - 1)][at(j - 1)];
                reached[at(i)][at(j)] =
                    from && a_(s_.letters[at(x.first + i)], s_.letters[at(y.first + j)]);
            }
        }
        return reached.back().back();
    }

    std::set<Substring> similar(const Substring& seed_substring) const {
        const auto all = substrings(2 * longest_);
        std::set<Substring> found{seed_substring};
        const bool steps_count = options_.spread == BundleSpread::depth;
        for (int step = 0; !steps_count || step < options_.depth; ++step) {
            std::set<Substring> more = found;
            for (const Substring& x : found) {
                for (const Substring& y : all) {
                    if (options_.spread == BundleSpread::closure_length &&
                        !agree(frames(y), frames(seed_substring)))
                        continue;
                    if (match(x, y)) more.insert(y);
                }
            }
            if (more.size() == found.size()) break;
            found = more;
        }
        return found;
    }

    /// That members are chosen by, in frames.
    double wanted_length(const std::set<Substring>& similar, const Substring& ref) const {
        if (options_.member_length == kinetome::MemberLength::seed) return frames(ref);
        double sum = 0;
        for (const Substring& ss : similar) sum += frames(ss);
        return std::floor(2 * sum / double(similar.size()) + 0.5) / 2;
    }

    std::vector<Substring> members(const std::set<Substring>& similar, const Substring& ref) const {
        std::vector<Substring> order(similar.begin(), similar.end());
        const double wanted = wanted_length(similar, ref);
        const bool ref_first = options_.member_length == kinetome::MemberLength::seed;
        const auto key = [&](const Substring& ss) {
            const double length = frames(ss);
            // Lengths are half frames: products of them are exact.
            const double ratio = std::max(length, wanted) / std::min(length, wanted);
            return std::tuple(ref_first && ss != ref, std::round(ratio * 1e9), length, ss);
        };
        std::ranges::sort(order, {}, key);
        std::vector<Substring> taken;
        for (const Substring& ss : order) {
            const bool free = std::ranges::all_of(taken, [&](const Substring& other) {
                return ss.last <= other.first || other.last <= ss.first;
            });
            if (free) taken.push_back(ss);
        }
        double sum = 0;
        for (const Substring& ss : taken) sum += frames(ss);
        const double mean = sum / double(taken.size());
        std::erase_if(taken, [&](const Substring& ss) { return !agree(frames(ss), mean); });
        std::ranges::sort(taken);
        return taken;
    }

    SubstringBundle largest(int32_t c) const {
        SubstringBundle best;
        double most = 0;
        for (const Substring& window : substrings(longest_)) {
            if (window.first > c || window.last < c) continue;
            const auto chosen = members(similar(window), window);
            if (chosen.size() < 2) continue;
            double width = 0;
            for (const Substring& ss : chosen) width += frames(ss);
            width /= double(chosen.size());
            const double volume = double(chosen.size() - 1) * std::pow(width, options_.rho);
            if (volume > most) best.members = chosen;
            most = std::max(most, volume);
        }
        if (!best.members.empty()) return best;
        for (const Substring& pair : {Substring{c - 1, c}, Substring{c, c + 1}}) {
            if (pair.first < 0 || pair.last >= size() || !open(pair)) continue;
            if (best.members.empty() || frames(pair) < frames(best.members[0]))
                best.members = {pair};
        }
        return best;
    }

    const MotionString& s_;
    const AccessibilityMatrix& a_;
    const int64_t longest_;
    const MotionBundleOptions options_;
    std::vector<bool> p_;
};

inline std::vector<SubstringBundle> motion_bundles(const MotionString& string,
                                                   const AccessibilityMatrix& accessibility,
                                                   int64_t longest,
                                                   const MotionBundleOptions& options) {
    return Search(string, accessibility, longest, options).run();
}

}  // namespace reference
