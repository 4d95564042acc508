// What motion bundles are found by (S1 §3.3, §3.6).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kinetome {

/// How far the matching relation M is spread from a seed substring.
enum class BundleSpread {
    closure,         ///< its transitive closure (S1 Eq. 5)
    closure_near,    ///< the same, among letters whose means are also near (adjacent_step's median)
    closure_length,  ///< the same, among substrings whose lengths γ allows beside the seed's
    depth,           ///< so many steps of M from the seed
};

/// Of similar substrings that overlap, those are members whose lengths are nearest to this. γ is
/// held against the mean of the members either way.
enum class MemberLength {
    seed,  ///< the seed substring's, which is a member; where several are equivalent, that of the
           ///< one with the largest bundle
    mean,  ///< the mean of all that are similar, which S1 §3.4 speaks of; no member need hold the
           ///< seed
};

struct MotionBundleOptions {
    double rho = 1;      ///< ρ of Eq. 3: above 1 prefers longer bundles
    double gamma = 0.8;  ///< γ: least ratio between a submotion's length and the bundle's mean
    BundleSpread spread = BundleSpread::depth;  ///< of the matching relation
    int32_t depth = 1;                          ///< steps of it, where the spread is `depth`
    /// Of the steps between the means of adjacent letters: no letters farther apart are matched; 1:
    /// τ alone tells
    double step_quantile = 0.75;
    MemberLength member_length = MemberLength::seed;  ///< that members are chosen by
    uint64_t seed = 1;  ///< names the instance of a letter to begin at
};

/// "closure", "closure-near", "closure-length", "depth:2".
std::string spread_text(const MotionBundleOptions& options);
/// Sets spread and depth. Throws std::invalid_argument for any other text.
void parse_spread(std::string_view text, MotionBundleOptions& options);

}  // namespace kinetome
