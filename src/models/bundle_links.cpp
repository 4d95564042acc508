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

namespace kinetome {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

RowRange grown(const RowRange& range, int64_t by, const RowRange& within) {
    return {std::max(within.first, range.first - by), std::min(within.end, range.end + by)};
}

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
        !(options.unlike > 0) || !(options.reach > 0) || !(options.own_reach > 0))
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
            const RowRange member{clip.first + piece.first, clip.first + piece.end};
            const int64_t missing = std::max<int64_t>(0, options.surroundings - member.size());
            own.push_back(speakers.occurrences.size());
            speakers.occurrences.push_back({member, grown(member, (missing + 1) / 2, clip),
                                            grown(member, options.surroundings, clip)});
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

/// Bundles are named by their places in Speakers here.
class Linking {
  public:
    Linking(const MatrixFView& rows, Speakers speakers, const BundleLinkOptions& options,
            int threads)
        : speakers_(std::move(speakers)),
          members_(rows, speakers_.occurrences, options),
          options_(options),
          threads_(threads),
          kinds_(count()) {}

    BundleLinks link() {
        BundleLinks result;
        find_usual();
        result.usual_cost = usual_cost_;
        result.usual_unlikeness = usual_unlikeness_;
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

    int64_t count() const { return static_cast<int64_t>(speakers_.bundles.size()); }
    int32_t subject(int32_t bundle) const {
        return speakers_.subject_of[static_cast<size_t>(bundle)];
    }
    const std::vector<size_t>& members(int32_t bundle) const {
        return speakers_.of_bundle[static_cast<size_t>(bundle)];
    }

    void find_usual() {
        const auto bundles = static_cast<size_t>(count());
        std::vector<std::vector<Agreement>> of_bundle(bundles);
        parallel_for(threads_, count(), [&](int64_t b) {
            const auto& own = members(static_cast<int32_t>(b));
            for (const size_t from : own) {
                Agreement best;
                for (const size_t to : own) {
                    if (members_.share_surroundings(from, to)) continue;
                    const Agreement found = members_.find(from, to, best.cost, infinite);
                    if (found.cost < best.cost) best = found;
                }
                if (best.cost < infinite) of_bundle[static_cast<size_t>(b)].push_back(best);
            }
        });
        std::vector<double> costs, unlikeness;
        for (const auto& own : of_bundle) {
            for (const Agreement& one : own) {
                costs.push_back(one.cost);
                unlikeness.push_back(one.unlikeness);
            }
        }
        usual_cost_ = median(std::move(costs));
        usual_unlikeness_ = median(std::move(unlikeness));
    }

    template <class Bound>
    double least(int32_t from, int32_t to, const Bound& bound) const {
        double least = infinite;
        for (const size_t a : members(from)) {
            for (const size_t b : members(to)) least = std::min(least, bound(a, b));
        }
        return least;
    }

    /// No cost of the two is less; infinite as soon as that is above `at_most`.
    double bound(int32_t a, int32_t b, double at_most) const {
        const auto rough = [&](size_t i, size_t j) { return members_.rough_bound(i, j); };
        const auto tight = [&](size_t i, size_t j) { return members_.bound(i, j); };
        if (least(a, b, rough) > at_most || least(b, a, rough) > at_most) return infinite;
        const double there = least(a, b, tight);
        if (there > at_most) return infinite;
        const double cost = std::max(there, least(b, a, tight));
        return cost > at_most ? infinite : cost;
    }

    /// The cheapest path from a member of the one to a member of the other.
    double way(int32_t from, int32_t to, double at_most) const {
        double best = at_most;
        bool found = false;
        for (const size_t a : members(from)) {
            for (const size_t b : members(to)) {
                if (members_.bound(a, b) > best) continue;
                const double cost = members_.find(a, b, best, usual_unlikeness_).cost;
                if (cost > best) continue;
                best = cost;
                found = true;
            }
        }
        return found ? best : infinite;
    }

    /// How far apart two bundles are that agree; infinite when they do not, or not within at_most.
    double distance(int32_t a, int32_t b, double at_most) const {
        const double there = way(a, b, at_most);
        return there == infinite ? infinite : std::max(there, way(b, a, at_most));
    }

    void unite_kinds() {
        const double at_most = options_.own_reach * usual_cost_;
        std::map<int32_t, std::vector<int32_t>> of_subjects;
        for (int32_t b = 0; b < count(); ++b) of_subjects[subject(b)].push_back(b);
        parallel_for(threads_, count(), [&](int64_t i) {
            const auto a = static_cast<int32_t>(i);
            for (const int32_t b : of_subjects.at(subject(a))) {
                if (b <= a || kinds_.together(a, b)) continue;
                if (bound(a, b, at_most) <= at_most && distance(a, b, at_most) <= at_most)
                    kinds_.unite(a, b);
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
        const double at_most = options_.reach * usual_cost_;
        struct Candidate {
            int32_t subject, bundle;
            double bound;
        };
        std::vector<Candidate> candidates;
        for (int32_t b = 0; b < count(); ++b) {
            if (subject(b) == subject(a)) continue;
            const double least = bound(a, b, at_most);
            if (least <= at_most) candidates.push_back({subject(b), b, least});
        }
        std::ranges::sort(candidates, {}, [](const Candidate& one) {
            return std::tuple(one.subject, one.bound, one.bundle);
        });
        std::vector<Near> near;
        for (const Candidate& one : candidates) {
            if (near.empty() || near.back().subject != one.subject)
                near.push_back({.subject = one.subject});
            Near& best = near.back();
            const double allowed = std::min(at_most, best.cost);
            if (one.bound > allowed) continue;
            const double cost = distance(a, one.bundle, allowed);
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
                if (kinds_.together(own->bundle, a))
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
    double usual_cost_ = 0, usual_unlikeness_ = 0;
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
