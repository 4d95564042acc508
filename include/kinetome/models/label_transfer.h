// Labels carried over from primitives that have one to primitives that have none (S3 §6.1).
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/math/warp_search.h"
#include "kinetome/models/corpus_primitive.h"

namespace kinetome {

/// Distances are those of the features (cm).
struct LabelTransferOptions {
    double threshold = 108;  ///< mean cost of the path to a label, at most: another performer may
                             ///< be half as far away again as poses of one may (r = 72)
    double lead = 0.85;      ///< what costs less than this share of any other label leads enough
    double recognised = 1;   ///< below 1: limits are learned that let this share of the known
                             ///< primitives pass. Only where every movement has a label: they
                             ///< hardly keep out one that has none
};

/// How near a label must be to be given.
struct LabelLimits {
    double threshold = 0;  ///< at most
    double lead = 1;       ///< and no other label this share of it or less: cost / lead
};

/// What is known of a primitive's label, and why.
struct LabelGuess {
    int32_t label = -1;  ///< -1: none is near enough, or two are nearly as near
    double cost = std::numeric_limits<double>::infinity();   ///< of the nearest label within the
                                                             ///< threshold, given or not
    double rival = std::numeric_limits<double>::infinity();  ///< of the next one, if it is near
                                                             ///< enough to stand against the label
    int64_t source = -1;  ///< the known primitive in which the middle of the nearest label's path
                          ///< lies, by its place in the list; -1 without a path
    bool operator==(const LabelGuess&) const = default;
};

/// Primitives with labels, ready to be compared with others.
///
/// A primitive is looked for, by subsequence dynamic time warping (slope_limited_steps,
/// WarpWeight::first), in runs of known primitives of one label that adjoin each other, so that it
/// may begin at another moment of the movement than they do. A label costs what its cheapest path
/// does; of equal ones the earlier primitive is named. All is found as if every path were tried.
class KnowledgeBase {
  public:
    /// `labels` has one for each primitive of `features` (n × d); those below 0 are left out.
    /// Throws std::invalid_argument when the lists disagree, for a primitive that is empty or lies
    /// outside the features, and for a value in one that is not finite.
    KnowledgeBase(const MatrixFView& features, std::span<const CorpusPrimitive> primitives,
                  std::span<const int32_t> labels);

    /// Those of the options, or what the known primitives teach: the least threshold and lead that
    /// would each let the share `recognised` of them have their own label from other clips, were it
    /// not known; no higher threshold than the options' and no lower lead. Too few teach nothing
    /// (below 19 at a share of 0.95); of many 512, evenly spaced, are asked. Throws
    /// std::invalid_argument for options that are not positive, or a lead or share above 1.
    LabelLimits limits(const LabelTransferOptions& options, int threads) const;

    /// The label of a primitive of m × d features. Throws what WarpSearch::query throws.
    LabelGuess label_of(const MatrixFView& primitive, const LabelLimits& limits) const;

  private:
    struct Run {
        int32_t label = -1;
        int64_t clip = 0;
        std::vector<int64_t> sources;  ///< primitives, by their place in the list
        std::vector<int64_t> ends;     ///< of each, by row of the run
    };
    struct Place {
        int64_t run = 0;
        RowRange rows;  ///< of the run
    };
    /// What a primitive would cost by other clips, were its label not known.
    struct OwnLabel {
        double cost = std::numeric_limits<double>::infinity();
        double share_of_next = 0;  ///< of what the next label costs; 0: that one is far away
    };
    class Search;

    std::vector<Place> places() const;  ///< of the known primitives
    OwnLabel own_label(const Place& place, double lead) const;
    int64_t source_of(const MatrixFView& primitive, int64_t run, double cost) const;

    std::vector<Run> runs_;
    std::optional<WarpSearch> search_;  ///< of the runs
};

/// The label of each of the primitives, within the limits that the known ones teach. The same for
/// any number of threads.
std::vector<LabelGuess> transfer_labels(const KnowledgeBase& known, const MatrixFView& features,
                                        std::span<const CorpusPrimitive> primitives,
                                        const LabelTransferOptions& options, int threads);

}  // namespace kinetome
