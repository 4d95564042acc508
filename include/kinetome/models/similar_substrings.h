// All substrings similar to a seed substring (S1 §3.4, Eq. 5).
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "kinetome/models/bundle_options.h"
#include "kinetome/models/reach_tables.h"

namespace kinetome {

/// F̄(last) - F̄(first) in half frames, which are whole numbers. Both letters are of one clip.
int64_t half_frames(const MotionString& string, const Substring& substring);

/// Spreads the matching relation breadth first through the open substrings of 2 to
/// context.most_letters letters.
template <int Words>
class SimilarSubstrings {
  public:
    SimilarSubstrings(const MatchingContext& context, const MotionBundleOptions& options,
                      const BundleResources& resources);

    /// Makes the reach tables of several seeds at once.
    void prepare(std::span<const Substring> seeds) { tables_.prepare(seeds); }
    /// M, the seed first and the others in no order that means anything. The seed is open.
    std::vector<Substring> find(const Substring& seed);

  private:
    using Level = std::vector<Substring>;

    /// Whether the relation may be spread from or to a substring of that length.
    bool length_allowed(const Substring& substring) const;
    /// Leaves out those whose letters are those of one that was spread from before: their matches
    /// are the same.
    Level of_new_letters(const Level& level);
    bool same_letters(const Substring& a, const Substring& b) const;
    uint64_t letter_hash(const Substring& substring) const;
    /// Of these, which have different letters; what is reached is put behind what is there.
    void spread_from(std::span<const Substring> sources, Level& reached);
    void reach(std::span<const ReachCell<Words>> matches, Level& reached);
    /// The same, the ranks sharing the sources by their first letters.
    void spread_shared(std::span<const Substring> sources, Communicator& ranks, Level& reached);
    /// Marks a substring as reached.
    void visit(const Substring& substring);

    const MatchingContext& context_;
    const MotionBundleOptions options_;
    const BundleResources resources_;
    ReachTables<Words> tables_;
    std::vector<uint64_t> hashes_{0};  ///< of all letters before each one
    std::vector<uint64_t> powers_{1};  ///< of the hash's base

    int64_t seed_half_frames_ = 0;
    std::vector<ReachMask<Words>> visited_;  ///< by last letter; bit d: the one d letters before it
    std::vector<int32_t> visited_lasts_;     ///< whose masks have a bit
    std::unordered_multimap<uint64_t, Substring> spread_;  ///< by hash of their letters
};

}  // namespace kinetome
