#include "kinetome/models/bundle_links.h"

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "disjoint_sets.h"
#include "kinetome/base/parallel.h"
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
            int threads)
        : speakers_(std::move(speakers)),
          members_(measured(rows, speakers_), speakers_.occurrences, options),
          options_(options),
          threads_(threads),
          kinds_(count()) {}

    BundleLinks link() {
        BundleLinks result;
        find_usual();
        result.usual_cost = usual_cost_;
        unite_kinds();
        result.kind_of = kinds_by_bundle();
        if (usual_cost_ > 0) result.links = links();
        return result;
    }

  private:
    struct Near {
        int32_t subject = 0;
        int32_t bundle = -1;  ///< none yet
        double cost = infinite;
    };

    struct Candidate {
        int32_t subject = 0;
        double glance = 0;
        int32_t bundle = 0;
        auto operator<=>(const Candidate&) const = default;
    };

    int64_t count() const { return static_cast<int64_t>(speakers_.bundles.size()); }
    int32_t subject(int32_t bundle) const {
        return speakers_.subject_of[static_cast<size_t>(bundle)];
    }
    const std::vector<size_t>& members(int32_t bundle) const {
        return speakers_.of_bundle[static_cast<size_t>(bundle)];
    }

    void find_usual() {
        const auto bundles = static_cast<size_t>(count());
        std::vector<std::vector<double>> of_bundle(bundles);
        parallel_for(threads_, count(), [&](int64_t b) {
            const auto& own = members(static_cast<int32_t>(b));
            for (const size_t from : own) {
                double best = infinite;
                for (const size_t to : own) {
                    if (members_.share_surroundings(from, to)) continue;
                    best = std::min(best, members_.find(from, to, best).cost);
                }
                if (best < infinite) of_bundle[static_cast<size_t>(b)].push_back(best);
            }
        });
        std::vector<double> costs;
        for (const auto& own : of_bundle) costs.insert(costs.end(), own.begin(), own.end());
        usual_cost_ = median(std::move(costs));
    }

    /// How far the middle of a member of the one is from the nearest of the other.
    double glances(int32_t from, int32_t to) const {
        double least = infinite;
        for (const size_t i : members(from)) {
            for (const size_t j : members(to)) least = std::min(least, members_.glance(i, j));
        }
        return least;
    }

    /// How far the one is from the other, by the members that are nearest.
    double way(int32_t from, int32_t to, double at_most) const {
        const double reach = options_.reach * usual_cost_;
        double least = infinite;
        for (const size_t a : members(from)) {
            for (const size_t b : members(to)) {
                if (members_.glance(a, b) > reach) continue;
                const Agreement found = members_.find(a, b, reach);
                if (found.cost > reach) continue;
                least = std::min(least, found.cost / usual_cost_ * found.unlikeness);
            }
        }
        return least <= at_most ? least : infinite;
    }

    /// How far apart two bundles are that agree; infinite when they do not, or not within at_most.
    double distance(int32_t a, int32_t b, double at_most) const {
        const double there = way(a, b, at_most);
        return there == infinite ? infinite : std::max(there, way(b, a, at_most));
    }

    /// Of each subject the bundles that look nearest, within reach, by subject and nearness.
    template <class Wanted>
    std::vector<Candidate> candidates(int32_t a, double reach, const Wanted& wanted) const {
        std::vector<Candidate> all;
        for (int32_t b = 0; b < count(); ++b) {
            if (b == a || !wanted(subject(b))) continue;
            const double there = glances(a, b);
            if (there > reach) continue;
            const double glance = std::max(there, glances(b, a));
            if (glance <= reach) all.push_back({subject(b), glance, b});
        }
        std::ranges::sort(all);
        std::vector<Candidate> nearest;
        int64_t of_subject = 0;
        for (const Candidate& one : all) {
            if (nearest.empty() || nearest.back().subject != one.subject) of_subject = 0;
            if (of_subject++ < options_.candidates) nearest.push_back(one);
        }
        return nearest;
    }

    void unite_kinds() {
        const double reach = options_.reach * usual_cost_;
        parallel_for(threads_, count(), [&](int64_t i) {
            const auto a = static_cast<int32_t>(i);
            const auto own = [&](int32_t other) { return other == subject(a); };
            for (const Candidate& one : candidates(a, reach, own)) {
                if (kinds_.together(a, one.bundle)) continue;
                if (distance(a, one.bundle, farthest) <= farthest) kinds_.unite(a, one.bundle);
            }
        });
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

    /// The nearest bundle of each other body that agrees with one, by subject.
    std::vector<Near> nearest(int32_t a) const {
        const double reach = options_.reach * usual_cost_;
        const auto others = [&](int32_t other) { return other != subject(a); };
        std::vector<Near> near;
        // What looks nearest comes first, so that the others can be given up soon.
        for (const Candidate& one : candidates(a, reach, others)) {
            if (near.empty() || near.back().subject != one.subject)
                near.push_back({.subject = one.subject});
            Near& best = near.back();
            const double cost = distance(a, one.bundle, std::min(farthest, best.cost));
            if (std::pair(cost, one.bundle) < std::pair(best.cost, best.bundle))
                best = {one.subject, one.bundle, cost};
        }
        std::erase_if(near, [](const Near& one) { return one.bundle < 0; });
        return near;
    }

    std::vector<BundleLink> links() {
        std::vector<std::vector<Near>> near(static_cast<size_t>(count()));
        parallel_for(threads_, count(), [&](int64_t a) {
            near[static_cast<size_t>(a)] = nearest(static_cast<int32_t>(a));
        });
        std::map<std::pair<int32_t, int32_t>, double> linked;
        for (int32_t a = 0; a < count(); ++a) {
            for (const Near& other : near[static_cast<size_t>(a)]) {
                const auto& back = near[static_cast<size_t>(other.bundle)];
                const auto own = std::ranges::lower_bound(back, subject(a), {}, &Near::subject);
                // Nothing that is nearer where others look nearer than this one.
                const bool none = own == back.end() || own->subject != subject(a);
                if (none || own->cost >= other.cost || kinds_.together(own->bundle, a))
                    linked[std::minmax(a, other.bundle)] = other.cost;
            }
        }
        std::vector<BundleLink> links;
        for (const auto& [pair, cost] : linked) {
            links.push_back({speakers_.bundles[static_cast<size_t>(pair.first)],
                             speakers_.bundles[static_cast<size_t>(pair.second)], cost});
        }
        return links;
    }

    Speakers speakers_;
    MemberAgreement members_;
    BundleLinkOptions options_;
    int threads_;
    DisjointSets kinds_;
    double usual_cost_ = 0;
};

}  // namespace

BundleLinks link_bundles(const MatrixFView& rows, std::span<const RowRange> clips,
                         std::span<const BundleMember> members, std::span<const int32_t> subject_of,
                         const BundleLinkOptions& options, int threads) {
    check(rows, clips, members, subject_of, options);
    if (members.empty()) return {};
    return Linking(rows, speakers_of(clips, members, subject_of, options), options, threads).link();
}

}  // namespace kinetome
