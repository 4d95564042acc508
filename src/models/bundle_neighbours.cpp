#include "bundle_neighbours.h"

#include <algorithm>
#include <array>

namespace kinetome {
namespace {

/// So many bundles must agree with either of two, beside the other, to tell anything about them.
constexpr int64_t least_company = 2;

/// What the bundles of a third body tell about two.
struct Witness {
    bool near_both = false, agrees_with_both = false, as_near_to_one = false;

    int speaks_against() const { return int{as_near_to_one && !agrees_with_both} - int{near_both}; }
};

}  // namespace

BundleNeighbours::BundleNeighbours(std::span<const BundleDistance> within,
                                   std::span<const int32_t> subject_of)
    : subject_of_(subject_of.begin(), subject_of.end()), neighbours_(subject_of.size()) {
    for (const BundleDistance& pair : within) {
        const auto add = [&](int32_t to, int32_t bundle) {
            neighbours_[static_cast<size_t>(to)].push_back(
                {subject_of[static_cast<size_t>(bundle)], bundle, pair.most, pair.agree()});
        };
        add(pair.first, pair.second);
        add(pair.second, pair.first);
    }
    for (auto& of_one : neighbours_) std::ranges::sort(of_one, {}, &Neighbour::place);
}

template <class Visit>
void BundleNeighbours::visit_neighbours_of_either(int32_t a, int32_t b, const Visit& visit) const {
    auto one = of(a).begin(), other = of(b).begin();
    const auto one_end = of(a).end(), other_end = of(b).end();
    while (one != one_end || other != other_end) {
        const bool of_one =
            one != one_end && (other == other_end || one->place() <= other->place());
        const bool of_other =
            other != other_end && (one == one_end || other->place() <= one->place());
        visit(of_one ? &*one : nullptr, of_other ? &*other : nullptr);
        one += of_one;
        other += of_other;
    }
}

bool BundleNeighbours::keep_company(int32_t a, int32_t b, double share) const {
    int64_t with_one = 0, with_other = 0, with_both = 0;
    visit_neighbours_of_either(a, b, [&](const Neighbour* one, const Neighbour* other) {
        const bool agrees_with_one = one && one->agrees, agrees_with_other = other && other->agrees;
        with_one += agrees_with_one;
        with_other += agrees_with_other;
        with_both += agrees_with_one && agrees_with_other;
    });
    const int64_t possible = std::min(with_one, with_other) - 1;  // but for each other
    return possible < least_company || double(with_both) >= share * double(possible);
}

bool BundleNeighbours::contradict(int32_t a, int32_t b, double most) const {
    const std::array own = {subject_of_[static_cast<size_t>(a)],
                            subject_of_[static_cast<size_t>(b)]};
    int against = 0;
    int32_t subject = -1;
    Witness body;
    visit_neighbours_of_either(a, b, [&](const Neighbour* one, const Neighbour* other) {
        const int32_t its = (one ? one : other)->subject;
        if (its == own[0] || its == own[1]) return;
        if (its != subject) {
            against += body.speaks_against();
            body = {};
            subject = its;
        }
        const auto no_farther = [&](const Neighbour* neighbour) {
            return neighbour && neighbour->agrees && neighbour->most <= most;
        };
        body.near_both |= one && other;
        body.agrees_with_both |= one && other && one->agrees && other->agrees;
        body.as_near_to_one |= no_farther(one) || no_farther(other);
    });
    return against + body.speaks_against() > 0;
}

}  // namespace kinetome
