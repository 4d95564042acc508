#include "bundle_distances.h"

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "kinetome/base/pack_fields.h"
#include "kinetome/base/shared_items.h"
#include "kinetome/math/quantiles.h"
#include "member_metric.h"

namespace kinetome {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

MatrixF measured(const MatrixFView& rows, const Speakers& speakers) {
    std::vector<RowRange> members;
    for (const Occurrence& one : speakers.occurrences) members.push_back(one.member);
    return rows_by_member_metric(rows, members, speakers.of_bundle);
}

/// How far a bundle is from another.
struct Way {
    double nearest = infinite;  ///< by the member that is nearest
    double most = infinite;     ///< within which most members are
};

void pack(Packer& out, const Way& way) {
    pack_all(out, way.nearest, way.most);
}
void unpack(Unpacker& in, Way& way) {
    unpack_all(in, way.nearest, way.most);
}

class Comparison {
  public:
    Comparison(const MatrixFView& rows, const Speakers& speakers, const BundleLinkOptions& options,
               const Workers& workers)
        : speakers_(speakers),
          members_(measured(rows, speakers_), speakers_.occurrences, options),
          options_(options),
          workers_(workers) {}

    BundleDistances compare() {
        find_usual();
        BundleDistances result{usual_cost_, {}};
        if (!(usual_cost_ > 0)) return result;
        const std::vector<Pair> pairs = compared_pairs();
        const auto ways = shared_items<Way>(
            static_cast<int64_t>(pairs.size()), workers_,
            [&](int64_t pair) { return both_ways(pairs[static_cast<size_t>(pair)]); });
        for (size_t i = 0; i < pairs.size(); ++i) {
            if (ways[i].nearest <= farthest)
                result.within.push_back(
                    {pairs[i].first, pairs[i].second, ways[i].nearest, ways[i].most});
        }
        return result;
    }

  private:
    struct Candidate {
        int32_t subject = 0;
        double glance = 0;
        int32_t bundle = 0;
        auto operator<=>(const Candidate&) const = default;
    };

    using Pair = std::pair<int32_t, int32_t>;

    int64_t count() const { return static_cast<int64_t>(speakers_.bundles.size()); }
    int32_t subject(int32_t bundle) const {
        return speakers_.subject_of[static_cast<size_t>(bundle)];
    }
    const std::vector<size_t>& members(int32_t bundle) const {
        return speakers_.of_bundle[static_cast<size_t>(bundle)];
    }
    double reach() const { return options_.reach * usual_cost_; }

    /// Of each member the least cost to another of its bundle.
    std::vector<double> own_costs(int32_t bundle) const {
        std::vector<double> costs;
        for (const size_t from : members(bundle)) {
            double best = infinite;
            for (const size_t to : members(bundle)) {
                if (!members_.share_surroundings(from, to))
                    best = std::min(best, members_.find(from, to, infinite).cost);
            }
            if (best < infinite) costs.push_back(best);
        }
        return costs;
    }

    void find_usual() {
        std::vector<double> costs;
        for (const auto& own : shared_items<std::vector<double>>(
                 count(), workers_,
                 [&](int64_t bundle) { return own_costs(static_cast<int32_t>(bundle)); }))
            costs.insert(costs.end(), own.begin(), own.end());
        usual_cost_ = lower_quantile(std::move(costs), 0.5);
    }

    /// How far the middle of a member of the one is from the nearest of the other, if within reach.
    double glances(int32_t from, int32_t to) const {
        double least = infinite;
        for (const size_t i : members(from)) {
            for (const size_t j : members(to)) {
                if (members_.glance_bound(i, j) <= std::min(least, reach()))
                    least = std::min(least, members_.glance(i, j));
            }
        }
        return least;
    }

    /// Of each body the bundles that look nearest, within reach.
    std::vector<int32_t> candidates(int32_t a) const {
        std::vector<Candidate> all;
        for (int32_t b = 0; b < count(); ++b) {
            if (b == a) continue;
            const double there = glances(a, b);
            if (there > reach()) continue;
            const double glance = std::max(there, glances(b, a));
            if (glance <= reach()) all.push_back({subject(b), glance, b});
        }
        std::ranges::sort(all);
        std::vector<int32_t> nearest;
        int64_t of_subject = 0;
        for (size_t i = 0; i < all.size(); ++i) {
            of_subject = i > 0 && all[i - 1].subject == all[i].subject ? of_subject + 1 : 0;
            if (of_subject < options_.candidates) nearest.push_back(all[i].bundle);
        }
        return nearest;
    }

    /// Pairs of which either is a candidate of the other.
    std::vector<Pair> compared_pairs() const {
        const auto candidates_of = shared_items<std::vector<int32_t>>(
            count(), workers_,
            [&](int64_t bundle) { return candidates(static_cast<int32_t>(bundle)); });
        std::vector<Pair> pairs;
        for (int32_t a = 0; a < count(); ++a) {
            for (const int32_t b : candidates_of[static_cast<size_t>(a)])
                pairs.emplace_back(std::minmax(a, b));
        }
        std::ranges::sort(pairs);
        const auto repeated = std::ranges::unique(pairs);
        pairs.erase(repeated.begin(), repeated.end());
        return pairs;
    }

    double way_of_member(size_t member, int32_t to) const {
        double least = infinite;
        for (const size_t other : members(to)) {
            if (members_.glance_bound(member, other) > reach() ||
                members_.glance(member, other) > reach())
                continue;
            const Agreement found = members_.find(member, other, reach());
            if (found.cost <= reach())
                least = std::min(least, found.cost / usual_cost_ * found.unlikeness);
        }
        return least;
    }

    Way way(int32_t from, int32_t to) const {
        std::vector<double> ways;
        for (const size_t member : members(from)) ways.push_back(way_of_member(member, to));
        std::ranges::sort(ways);
        return {ways.front(), ways[ways.size() / 2]};
    }

    Way both_ways(const Pair& pair) const {
        const Way there = way(pair.first, pair.second);
        if (there.nearest > farthest) return {};
        const Way back = way(pair.second, pair.first);
        return {std::max(there.nearest, back.nearest), std::max(there.most, back.most)};
    }

    const Speakers& speakers_;
    MemberAgreement members_;
    BundleLinkOptions options_;
    Workers workers_;
    double usual_cost_ = 0;
};

}  // namespace

Speakers speakers_of(std::span<const RowRange> clips, std::span<const BundleMember> members,
                     std::span<const int32_t> subject_of, const BundleLinkOptions& options) {
    std::map<int32_t, std::vector<MotionPiece>> of_bundles;
    for (const BundleMember& member : members) of_bundles[member.bundle].push_back(member.frames);
    Speakers speakers;
    for (auto& [bundle, pieces] : of_bundles) {
        std::ranges::sort(pieces, {}, [](const MotionPiece& piece) {
            return std::tuple(piece.clip, piece.first, piece.end);
        });
        speakers.bundles.push_back(bundle);
        speakers.subject_of.push_back(subject_of[static_cast<size_t>(pieces.front().clip)]);
        auto& own = speakers.of_bundle.emplace_back();
        const auto count = static_cast<int64_t>(pieces.size());
        const int64_t taken = std::min(count, options.members);
        for (int64_t i = 0; i < taken; ++i) {
            const MotionPiece& piece = pieces[static_cast<size_t>(i * count / taken)];
            const RowRange& clip = clips[static_cast<size_t>(piece.clip)];
            own.push_back(speakers.occurrences.size());
            speakers.occurrences.push_back(
                {{clip.first + piece.first, clip.first + piece.end}, clip});
        }
    }
    return speakers;
}

BundleDistances bundle_distances(const MatrixFView& rows, const Speakers& speakers,
                                 const BundleLinkOptions& options, const Workers& workers) {
    return Comparison(rows, speakers, options, workers).compare();
}

}  // namespace kinetome
