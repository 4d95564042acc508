// Labels of a store's primitives: the user's own, and those transferred from them (S3 §6.1).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinetome/formats/annotation.h"
#include "kinetome/models/label_table.h"
#include "kinetome/models/label_transfer.h"
#include "kinetome/stages/export.h"
#include "kinetome/stages/stored_graph.h"

namespace kinetome {

/// The primitives of a generation side by side, in the order of its file.
struct PrimitiveFeatures {
    MatrixF features;  ///< all frames × d: those the neighbourhood graphs were searched in, as
                       ///< movement_rows
    std::vector<CorpusPrimitive> primitives;
};

/// Throws StoreError, and UsageError when the generation has no primitives.
PrimitiveFeatures read_primitive_features(const Generation& generation);

/// Labels as numbers from 0, in alphabetical order.
class LabelNames {
  public:
    explicit LabelNames(std::span<const ClipPrimitive> primitives);

    int32_t count() const { return static_cast<int32_t>(names_.size()); }
    const std::string& name(int32_t label) const { return names_[static_cast<size_t>(label)]; }
    /// One a primitive; -1: it has none.
    std::vector<int32_t> numbers(std::span<const ClipPrimitive> primitives) const;

  private:
    std::vector<std::string> names_;
};

/// What became of each primitive: `primitives` have the labels known and those transferred.
struct TransferredLabels {
    std::vector<ClipPrimitive> primitives;
    std::vector<bool> is_known;
    std::vector<LabelGuess> guesses;  ///< of those not known
};

/// Labels the primitives that have none by those that have one.
TransferredLabels transfer_labels(const PrimitiveFeatures& features,
                                  std::vector<ClipPrimitive> primitives,
                                  const LabelTransferOptions& options, int threads);

/// clip,first,end,label,origin,cost,source_clip,source_first: of every primitive. Origin is known,
/// transferred or none.
Table label_rows(const TransferredLabels& labels);

/// knowledge,label,examples,found,correct,missed,precision,recall: the labels transferred against
/// those of `truth`, and "all" together.
Table label_score(const TransferredLabels& labels, const std::vector<CycleRow>& truth);

/// The same, of labels that are transferred to each annotated take from all others, and, when takes
/// are named, from the first of them, the first two, …, to those that are not named (S3 Table 1).
/// Throws UsageError for a take that truth does not annotate.
Table label_tables(const PrimitiveFeatures& features, const std::vector<ClipPrimitive>& primitives,
                   const std::vector<CycleRow>& truth, const std::vector<std::string>& known_takes,
                   const LabelTransferOptions& options, int threads);

}  // namespace kinetome
