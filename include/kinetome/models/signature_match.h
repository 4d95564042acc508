// Where one cluster transition signature occurs in another, exactly or nearly (S2 §5.3).
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/signature.h"

namespace kinetome {

/// How two signatures are laid onto each other.
enum class MatchRule : uint8_t {
    pace,     ///< frame by frame: lengths of runs count, neither goes more than twice as fast
    repeats,  ///< run by run: each answers one or several of the other's, however long they are
    edit,     ///< run by run: runs are replaced, inserted and left out (S2: approximate strings)
};

/// Distances are those between runs, mm per marker.
struct SignatureMatchOptions {
    MatchRule rule = MatchRule::pace;
    double tolerance = std::numeric_limits<double>::infinity();  ///< mean distance of a match
    double shortest = 0.5;  ///< a match is no shorter than this share of the query,
    double longest = 2;     ///< and no longer than so many times it
    double overlap = 0.3;   ///< of two matches that share more of the shorter one, the nearer is it
    int32_t step = 8;       ///< pace: frames from one moment that is compared to the next
    double farthest = 100;  ///< repeats, edit: runs farther apart are no more different than that
    double gap = 5;  ///< edit: what inserting or leaving out costs beyond the distance to the
                     ///< nearer of the runs it happens between
};

struct SignatureMatch {
    RowRange frames;      ///< of the text
    double distance = 0;  ///< mean along the alignment, mm per marker
    bool operator==(const SignatureMatch&) const = default;
};

/// Nearer matches first, then those that begin, then those that end earlier.
bool operator<(const SignatureMatch& a, const SignatureMatch& b);

/// Whether they share more than `overlap` of the shorter one.
bool is_same_place(const RowRange& a, const RowRange& b, double overlap);

// Both dynamic programmes are semi-global (Sellers): the whole query, beginning and ending anywhere
// in the text. Of all alignments that end at one place the nearest counts; where two are equally
// near, the one that takes a step of both. Matches come nearest first.

/// Of a query of n runs in a text of m, by MatchRule::repeats or edit; `distances` (n × m) are
/// those between their runs. A match holds no more of the runs at its ends than the query has of
/// its own. Throws std::invalid_argument for MatchRule::pace and when the distances are not n × m.
std::vector<SignatureMatch> match_runs(std::span<const SignatureRun> query,
                                       std::span<const SignatureRun> text,
                                       const MatrixFView& distances,
                                       const SignatureMatchOptions& options);

/// Of a query of so many frames, by MatchRule::pace; `distances` (n × m) are those of n moments of
/// the query, evenly spread, from the middles of m consecutive steps of the text. A match is a
/// whole number of steps. Throws std::invalid_argument when the step is not positive.
std::vector<SignatureMatch> match_paces(int64_t query_frames, const MatrixFView& distances,
                                        const SignatureMatchOptions& options);

/// First runs of the text from which it has the leaves of the query, in its order: exact string
/// matching, lengths of runs aside.
std::vector<int64_t> exact_matches(std::span<const SignatureRun> query,
                                   std::span<const SignatureRun> text);

/// The frames that an alignment from run `first` to run `last` of the text takes.
RowRange matched_frames(std::span<const SignatureRun> query, std::span<const SignatureRun> text,
                        int64_t first, int64_t last);

}  // namespace kinetome
