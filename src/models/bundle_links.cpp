#include "kinetome/models/bundle_links.h"

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "disjoint_sets.h"
#include "kinetome/base/shared_items.h"
#include "member_agreement.h"
#include "member_metric.h"

namespace kinetome {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// What moves wholly unlike may be as far apart as members of one bundle usually are; what moves
/// more alike, farther in proportion.
constexpr double farthest = 1;

void check(const MatrixFView& rows, std::span<const RowRange> clips,
           std::span<const BundleMember> members, std::span<const int32_t> subject_of,
           const BundleLinkOptions& options) {
    if (clips.size() != subject_of.size())
        throw std::invalid_argument("each clip needs the number of its subject");
    for (const RowRange& clip : clips) {
        if (clip.first < 0 || clip.end < clip.first || clip.end > rows.rows())
            throw std::invalid_argument("a clip lies outside the rows");
    }
    for (const BundleMember& member : members) {
        const MotionPiece& frames = member.frames;
        if (member.bundle < 0) throw std::invalid_argument("a member is of no bundle");
        if (frames.clip < 0 || static_cast<size_t>(frames.clip) >= clips.size())
            throw std::invalid_argument("a member is of a clip that is not there");
        if (frames.first < 0 || frames.frames() < 1 ||
            frames.end > clips[static_cast<size_t>(frames.clip)].size())
            throw std::invalid_argument("a member is empty or reaches beyond its clip");
    }
    if (options.surroundings < 1 || options.slip < 0 || options.members < 1 ||
        options.candidates < 1 || !(options.reach > 0))
        throw std::invalid_argument("options of bundle links must be positive");
}

/// Bundles by number, and the members that speak for each.
struct Speakers {
    std::vector<int32_t> bundles;                ///< ascending
    std::vector<int32_t> subject_of;             ///< by place in `bundles`
    std::vector<std::vector<size_t>> of_bundle;  ///< by place: numbers of occurrences
    std::vector<Occurrence> occurrences;
};

/// Of bundles with more members than asked for some, evenly spaced by clip and row.
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

/// The lower of two middle ones; 0 of none.
double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

MatrixF measured(const MatrixFView& rows, const Speakers& speakers) {
    std::vector<RowRange> members;
    for (const Occurrence& one : speakers.occurrences) members.push_back(one.member);
    return rows_by_member_metric(rows, members, speakers.of_bundle);
}

/// Bundles are named by their places in Speakers here.
class Linking {
  public:
    Linking(const MatrixFView& rows, Speakers speakers, const BundleLinkOptions& options,
            const Workers& workers)
        : speakers_(std::move(speakers)),
          members_(measured(rows, speakers_), speakers_.occurrences, options),
          options_(options),
          workers_(workers),
          kinds_(count()) {}

    BundleLinks link() {
        BundleLinks result;
        find_usual();
        result.usual_cost = usual_cost_;
        if (usual_cost_ > 0) compare();
        result.kind_of = kinds_by_bundle();
        result.links = links();
        return result;
    }

  private:
    /// A bundle of another body, and how far it is.
    struct Near {
        int32_t subject = 0;
        int32_t bundle = 0;
        double distance = infinite;
    };

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
        usual_cost_ = median(std::move(costs));
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

    /// How far the one is from the other, by the members that are nearest.
    double way(int32_t from, int32_t to) const {
        double least = infinite;
        for (const size_t a : members(from)) {
            for (const size_t b : members(to)) {
                if (members_.glance_bound(a, b) > reach() || members_.glance(a, b) > reach())
                    continue;
                const Agreement found = members_.find(a, b, reach());
                if (found.cost <= reach())
                    least = std::min(least, found.cost / usual_cost_ * found.unlikeness);
            }
        }
        return least;
    }

    /// How far apart two bundles are, both ways; infinite when they do not agree.
    double distance(const Pair& pair) const {
        const double there = way(pair.first, pair.second);
        if (there > farthest) return infinite;
        const double both = std::max(there, way(pair.second, pair.first));
        return both > farthest ? infinite : both;
    }

    /// Unites kinds of motion, and finds the nearest bundle of each other body, by subject.
    void compare() {
        const std::vector<Pair> pairs = compared_pairs();
        const auto distances = shared_items<double>(
            static_cast<int64_t>(pairs.size()), workers_,
            [&](int64_t pair) { return distance(pairs[static_cast<size_t>(pair)]); });
        near_.resize(static_cast<size_t>(count()));
        for (size_t i = 0; i < pairs.size(); ++i) {
            const auto [a, b] = pairs[i];
            if (distances[i] == infinite) continue;
            if (subject(a) == subject(b)) {
                kinds_.unite(a, b);
            } else {
                keep_nearest(near_[static_cast<size_t>(a)], {subject(b), b, distances[i]});
                keep_nearest(near_[static_cast<size_t>(b)], {subject(a), a, distances[i]});
            }
        }
    }

    /// Of equally near ones the lower.
    static void keep_nearest(std::vector<Near>& near, const Near& one) {
        const auto place = std::ranges::lower_bound(near, one.subject, {}, &Near::subject);
        if (place == near.end() || place->subject != one.subject)
            near.insert(place, one);
        else if (std::pair(one.distance, one.bundle) < std::pair(place->distance, place->bundle))
            *place = one;
    }

    std::vector<int32_t> kinds_by_bundle() {
        std::vector<int32_t> kinds;
        for (int32_t b = 0; b < count(); ++b) {
            const auto bundle = static_cast<size_t>(speakers_.bundles[static_cast<size_t>(b)]);
            kinds.resize(bundle + 1, -1);
            kinds[bundle] = speakers_.bundles[static_cast<size_t>(kinds_.root(b))];
        }
        return kinds;
    }

    std::vector<BundleLink> links() {
        std::map<Pair, double> linked;
        for (int32_t a = 0; a < static_cast<int32_t>(near_.size()); ++a) {
            for (const Near& other : near_[static_cast<size_t>(a)]) {
                // The other has this one near, so that it has a nearest of this one's body.
                const Near& own = *std::ranges::lower_bound(
                    near_[static_cast<size_t>(other.bundle)], subject(a), {}, &Near::subject);
                if (own.distance >= other.distance || kinds_.together(own.bundle, a))
                    linked[std::minmax(a, other.bundle)] = other.distance;
            }
        }
        std::vector<BundleLink> links;
        for (const auto& [pair, distance] : linked) {
            links.push_back({speakers_.bundles[static_cast<size_t>(pair.first)],
                             speakers_.bundles[static_cast<size_t>(pair.second)], distance});
        }
        return links;
    }

    Speakers speakers_;
    MemberAgreement members_;
    BundleLinkOptions options_;
    Workers workers_;
    DisjointSets kinds_;
    std::vector<std::vector<Near>> near_;  ///< by bundle
    double usual_cost_ = 0;
};

}  // namespace

BundleLinks link_bundles(const MatrixFView& rows, std::span<const RowRange> clips,
                         std::span<const BundleMember> members, std::span<const int32_t> subject_of,
                         const BundleLinkOptions& options, const Workers& workers) {
    check(rows, clips, members, subject_of, options);
    if (members.empty()) return {};
    return Linking(rows, speakers_of(clips, members, subject_of, options), options, workers).link();
}

}  // namespace kinetome
