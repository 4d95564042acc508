// Dynamic time warping of rows of features (S3 §3): which moments of two movements answer each
// other, and at what cost.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "kinetome/base/matrix.h"

namespace kinetome {

/// How a path goes on: by so many rows of the first sequence and of the second. The cell it comes
/// to is on the path, those it passes over are not.
struct WarpStep {
    int32_t first = 1;
    int32_t second = 1;
    bool operator==(const WarpStep&) const = default;
};

/// Either sequence may stand still as long as it likes (S3 §3).
inline std::vector<WarpStep> unlimited_steps() {
    return {{1, 1}, {0, 1}, {1, 0}};
}
/// Neither sequence goes more than twice as fast as the other.
inline std::vector<WarpStep> slope_limited_steps() {
    return {{1, 1}, {1, 2}, {2, 1}};
}

/// How often the distance at a cell counts.
enum class WarpWeight {
    both,   ///< by the rows of both that the path went on by to come there (Sakoe & Chiba's
            ///< symmetric form): n + m in all, so that no path gains by being short or long
    first,  ///< by the rows of the first sequence alone: n in all
    cells,  ///< once
};

struct WarpOptions {
    std::vector<WarpStep> steps = slope_limited_steps();
    WarpWeight weight = WarpWeight::both;
    int64_t end_slip = 0;  ///< rows that one of the sequences may leave unmatched at each end; they
                           ///< count with the nearest cell of the path
    double radius = std::numeric_limits<double>::infinity();  ///< no path leads through a cell of
                                                              ///< rows farther apart
};

struct WarpCell {
    int32_t first = 0;   ///< row of the first sequence
    int32_t second = 0;  ///< row of the second
    bool operator==(const WarpCell&) const = default;
};

/// A path of least total cost; without cells, and of infinite cost, where there is none.
struct WarpPath {
    std::vector<WarpCell> cells;
    double total = std::numeric_limits<double>::infinity();  ///< weighted distances, added up
    double mean = std::numeric_limits<double>::infinity();   ///< total / weights
};

// Distances between rows are Euclidean, squares added in double column after column; costs are
// added from the beginning of a path to its end. Among paths of one cost the one is returned that
// slips least at its end and, followed back from there, begins as soon as it may, else takes the
// step listed first. All functions throw std::invalid_argument for sequences of different columns,
// for steps that do not lead on and for a negative slip. A sequence without rows has no path.
// Values are not checked: a path through one that is not finite is not found.

/// The path of least cost from the beginnings of n × d and m × d features to their ends. Memory
/// n · m bytes.
WarpPath warp(const MatrixFView& first, const MatrixFView& second, const WarpOptions& options = {});

/// The same where the n × m distances between the rows of the two are given.
WarpPath warp(const MatrixDView& distances, const WarpOptions& options = {});

/// The mean cost of that path where it is no more than `at_most`, else infinite: a search that can
/// no longer come to less is given up. Memory grows with m alone.
double warp_cost(const MatrixFView& first, const MatrixFView& second, const WarpOptions& options,
                 double at_most = std::numeric_limits<double>::infinity());

struct MatchOptions {
    double at_most = std::numeric_limits<double>::infinity();  ///< mean cost of a match
    std::vector<WarpStep> steps = slope_limited_steps();       ///< each goes on in the query
    double radius = std::numeric_limits<double>::infinity();   ///< as in WarpOptions
};

/// Where in a long sequence the query (the first sequence) occurs: of the best paths to each row of
/// the sequence, cells weighted by WarpWeight::first, those that are cheap enough; of those that
/// overlap in the sequence the cheaper, then the earlier. In the order of the sequence.
std::vector<WarpPath> warp_matches(const MatrixFView& query, const MatrixFView& sequence,
                                   const MatchOptions& options);

}  // namespace kinetome
