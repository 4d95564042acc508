// How well a take's primitives and their clusters agree with annotated repetitions and classes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/pieces.h"
#include "kinetome/models/truth_timeline.h"

namespace kinetome {

/// Sums over takes: add them up, then ask for shares.
struct PrimitiveScore {
    int64_t primitives = 0, cycles = 0;  ///< found, annotated
    int64_t activities = 0;              ///< annotated ones that have cycles
    int64_t exact = 0, within_one = 0;   ///< of these, how many hold as many primitives
    int64_t classified = 0, pure = 0;    ///< primitives with a class; with their cluster's class
    double exact_share() const;          ///< of activities; 0 without any
    double within_one_share() const;     ///< the same
    double purity() const;               ///< of primitives with a class; 0 without any
    PrimitiveScore& operator+=(const PrimitiveScore& other);
    bool operator==(const PrimitiveScore&) const = default;
};

/// The class that most of each primitive's frames outside zones have, the first of several; -1
/// without such frames. Throws std::invalid_argument for one that leaves the take.
std::vector<int32_t> classes_of_primitives(const TruthTimeline& truth,
                                           std::span<const RowRange> primitives);

/// Members that have the class which most members of their cluster have; those of class -1 do not
/// count. One cluster and one class a member.
int64_t pure_members(std::span<const int32_t> clusters, std::span<const int32_t> classes);

/// `cycles` are the annotated repetitions, `clusters` those of the primitives; both kinds of ranges
/// count frames as `truth` does and belong to the activity that holds their middle. Activities
/// without cycles are not counted.
PrimitiveScore score_primitives(const TruthTimeline& truth, std::span<const RowRange> cycles,
                                std::span<const RowRange> primitives,
                                std::span<const int32_t> clusters);

}  // namespace kinetome
