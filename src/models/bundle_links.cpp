#include "kinetome/models/bundle_links.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "bundle_distances.h"
#include "bundle_neighbours.h"
#include "disjoint_sets.h"

namespace kinetome {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

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
        options.candidates < 1 || !(options.reach > 0) || !(options.company >= 0))
        throw std::invalid_argument("options of bundle links must be positive");
}

/// A bundle of another body, and how far it is.
struct Near {
    int32_t subject = 0;
    int32_t bundle = 0;
    double distance = infinite;

    /// Of equally near ones the lower is.
    bool nearer_than(const Near& other) const {
        return std::pair(distance, bundle) < std::pair(other.distance, other.bundle);
    }
};

/// Of one bundle the nearest of each other body, by subject.
class NearestOfBodies {
  public:
    void keep(const Near& one) {
        const auto place = std::ranges::lower_bound(near_, one.subject, {}, &Near::subject);
        if (place == near_.end() || place->subject != one.subject)
            near_.insert(place, one);
        else if (one.nearer_than(*place))
            *place = one;
    }

    /// None of a body of which no bundle was kept.
    const Near* of(int32_t subject) const {
        const auto place = std::ranges::lower_bound(near_, subject, {}, &Near::subject);
        return place != near_.end() && place->subject == subject ? &*place : nullptr;
    }

    auto begin() const { return near_.begin(); }
    auto end() const { return near_.end(); }

  private:
    std::vector<Near> near_;
};

/// Bundles are named by their places in Speakers here.
class Linking {
  public:
    Linking(const Speakers& speakers, BundleDistances distances, double company)
        : speakers_(speakers),
          distances_(std::move(distances)),
          company_(company),
          neighbours_(distances_.within, speakers_.subject_of),
          kinds_(static_cast<int64_t>(speakers_.bundles.size())) {}

    BundleLinks link() {
        find_kinds();
        link_agreeing();
        link_kin();
        return {distances_.usual_cost, kinds_by_bundle(), links()};
    }

  private:
    using Pair = std::pair<int32_t, int32_t>;

    int32_t subject(int32_t bundle) const {
        return speakers_.subject_of[static_cast<size_t>(bundle)];
    }
    bool of_one_body(const BundleDistance& pair) const {
        return subject(pair.first) == subject(pair.second);
    }
    bool keep_company(int32_t a, int32_t b) const {
        return neighbours_.keep_company(a, b, company_);
    }

    void find_kinds() {
        for (const BundleDistance& pair : distances_.within) {
            if (pair.agree() && of_one_body(pair) && keep_company(pair.first, pair.second))
                kinds_.unite(pair.first, pair.second);
        }
    }

    /// Of each other body the nearest that agrees, if they keep company and are not contradicted;
    /// not where that one is nearer to another kind of motion of this body.
    void link_agreeing() {
        std::vector<NearestOfBodies> near(speakers_.bundles.size());
        for (const BundleDistance& pair : distances_.within) {
            const auto [a, b] = Pair(pair.first, pair.second);
            if (!pair.agree() || of_one_body(pair)) continue;
            near[static_cast<size_t>(a)].keep({subject(b), b, pair.most});
            near[static_cast<size_t>(b)].keep({subject(a), a, pair.most});
        }
        for (int32_t a = 0; a < static_cast<int32_t>(near.size()); ++a) {
            for (const Near& other : near[static_cast<size_t>(a)]) {
                // The other has this one near, so that it has a nearest of this one's body.
                const Near& back = *near[static_cast<size_t>(other.bundle)].of(subject(a));
                const bool nearest = back.distance >= other.distance;
                if ((nearest || kinds_.together(back.bundle, a)) && keep_company(a, other.bundle) &&
                    !neighbours_.contradict(a, other.bundle, other.distance))
                    linked_[std::minmax(a, other.bundle)] = other.distance;
            }
        }
    }

    Pair kinds_of(int32_t a, int32_t b) { return std::minmax(kinds_.root(a), kinds_.root(b)); }

    /// What has no link yet: with the nearest, by the members that are nearest, of those of other
    /// bodies whose kinds are linked with its own and that are not contradicted.
    void link_kin() {
        std::set<Pair> linked_kinds;
        std::vector<bool> is_linked(speakers_.bundles.size());
        for (const auto& [pair, distance] : linked_) {
            linked_kinds.insert(kinds_of(pair.first, pair.second));
            is_linked[static_cast<size_t>(pair.first)] = true;
            is_linked[static_cast<size_t>(pair.second)] = true;
        }
        std::vector<Near> nearest(speakers_.bundles.size());
        const auto improves = [&](int32_t bundle, const Near& there) {
            const auto of = static_cast<size_t>(bundle);
            return !is_linked[of] && there.nearer_than(nearest[of]);
        };
        for (const BundleDistance& pair : distances_.within) {
            if (of_one_body(pair) || !linked_kinds.contains(kinds_of(pair.first, pair.second)))
                continue;
            const Near first{subject(pair.first), pair.first, pair.nearest};
            const Near second{subject(pair.second), pair.second, pair.nearest};
            const bool of_first = improves(pair.first, second);
            const bool of_second = improves(pair.second, first);
            if (!(of_first || of_second) ||
                neighbours_.contradict(pair.first, pair.second, pair.most))
                continue;
            if (of_first) nearest[static_cast<size_t>(pair.first)] = second;
            if (of_second) nearest[static_cast<size_t>(pair.second)] = first;
        }
        for (int32_t a = 0; a < static_cast<int32_t>(nearest.size()); ++a) {
            const Near& other = nearest[static_cast<size_t>(a)];
            if (other.distance < infinite) linked_[std::minmax(a, other.bundle)] = other.distance;
        }
    }

    std::vector<int32_t> kinds_by_bundle() {
        std::vector<int32_t> kinds;
        for (size_t place = 0; place < speakers_.bundles.size(); ++place) {
            const auto bundle = static_cast<size_t>(speakers_.bundles[place]);
            const int32_t lowest = kinds_.root(static_cast<int32_t>(place));
            kinds.resize(bundle + 1, -1);
            kinds[bundle] = speakers_.bundles[static_cast<size_t>(lowest)];
        }
        return kinds;
    }

    std::vector<BundleLink> links() const {
        std::vector<BundleLink> links;
        for (const auto& [pair, distance] : linked_) {
            links.push_back({speakers_.bundles[static_cast<size_t>(pair.first)],
                             speakers_.bundles[static_cast<size_t>(pair.second)], distance});
        }
        return links;
    }

    const Speakers& speakers_;
    BundleDistances distances_;
    double company_;
    BundleNeighbours neighbours_;
    DisjointSets kinds_;
    std::map<Pair, double> linked_;  ///< how far apart they are
};

}  // namespace

BundleLinks link_bundles(const MatrixFView& rows, std::span<const RowRange> clips,
                         std::span<const BundleMember> members, std::span<const int32_t> subject_of,
                         const BundleLinkOptions& options, const Workers& workers) {
    check(rows, clips, members, subject_of, options);
    if (members.empty()) return {};
    const Speakers speakers = speakers_of(clips, members, subject_of, options);
    return Linking(speakers, bundle_distances(rows, speakers, options, workers), options.company)
        .link();
}

}  // namespace kinetome
