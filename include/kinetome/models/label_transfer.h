// Labels carried over from primitives that have one to primitives that have none (S3 §6.1).
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/math/knn.h"
#include "kinetome/models/corpus_primitive.h"

namespace kinetome {

/// Distances are those of the features (cm). They are wider than inside a take, where a primitive
/// has others of its performer beside it; the last two see to it that no label is guessed.
struct LabelTransferOptions {
    double radius = 96;     ///< no path leads through frames farther apart: it lies in the
                            ///< neighbourhood graph of the two primitives
    double threshold = 72;  ///< mean cost of the path to a label, at most
    double cover = 0.75;    ///< of a known primitive's length that a path to it takes, at least:
                            ///< all movements pass through a few common poses
    double lead = 0.8;      ///< the cost is below this share of what any other label costs
};

/// What is known of a primitive's label, and why.
struct LabelGuess {
    int32_t label = -1;  ///< -1: none is near enough, or two are nearly as near
    double cost = std::numeric_limits<double>::infinity();   ///< of the nearest label, given or not
    double rival = std::numeric_limits<double>::infinity();  ///< of the next one
    int64_t source = -1;  ///< the known primitive in which the middle of the nearest label's path
                          ///< lies, by its place in the list; -1 without a path
    bool operator==(const LabelGuess&) const = default;
};

/// Primitives with labels, ready to be compared with others.
///
/// A primitive is looked for, by subsequence dynamic time warping (slope_limited_steps,
/// WarpWeight::first), in runs of known primitives of one label that adjoin each other, so that it
/// may begin at another moment of the movement than they do. Of the paths to one frame the cheapest
/// counts. A label costs what its cheapest path does; of equal ones the earlier primitive is named.
class KnowledgeBase {
  public:
    /// `labels` has one for each primitive of `features` (n × d); those below 0 are left out.
    /// Throws std::invalid_argument when the lists disagree, for a primitive that is empty or lies
    /// outside the features, and for a value in one that is not finite.
    KnowledgeBase(const MatrixFView& features, std::span<const CorpusPrimitive> primitives,
                  std::span<const int32_t> labels, int threads);

    /// The label of a primitive of m × d features. Throws what KnnIndex::search throws.
    LabelGuess label_of(const MatrixFView& primitive, const LabelTransferOptions& options) const;

  private:
    struct Column {
        int32_t label = -1;  ///< -1: between two runs
        int32_t source = -1;
        int32_t frames = 0;  ///< of the source
    };
    class Search;

    Search search_for(const MatrixFView& primitive, double radius) const;

    std::vector<Column> columns_;     ///< all known frames, run after run with gaps between
    std::vector<int32_t> column_of_;  ///< by row of the index
    std::optional<KnnIndex> index_;   ///< nothing when nothing is known
};

/// The label of each of the primitives. The same for any number of threads.
std::vector<LabelGuess> transfer_labels(const KnowledgeBase& known, const MatrixFView& features,
                                        std::span<const CorpusPrimitive> primitives,
                                        const LabelTransferOptions& options, int threads);

}  // namespace kinetome
