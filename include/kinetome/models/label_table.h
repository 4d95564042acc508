// How far labels can be trusted that were transferred (S3 §6.1, Table 1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/corpus_primitive.h"
#include "kinetome/models/label_transfer.h"

namespace kinetome {

/// Primitives of one label, or of all.
struct LabelCounts {
    int64_t examples = 0;  ///< known
    int64_t found = 0;     ///< given the label
    int64_t correct = 0;   ///< of these, those that truly have it
    int64_t missed = 0;    ///< that have it and were given another or none

    double precision() const;  ///< 1 where nothing was found
    double recall() const;     ///< 1 where there was nothing to find
    bool operator==(const LabelCounts&) const = default;
};

struct LabelTable {
    std::vector<LabelCounts> labels;  ///< by label
    LabelCounts all;
};

/// Counts the given labels against the true ones, from 0 to below `label_count` (-1: none).
/// Primitives without a true label do not count. Throws std::invalid_argument when the lists have
/// different lengths or a label is out of range.
LabelTable label_table(std::span<const int32_t> true_labels, std::span<const int32_t> given_labels,
                       int32_t label_count);

/// Tables of growing knowledge: the k-th knows the primitives of the first k of `known_clips` and
/// transfers their labels to those of all clips that are none of these (so that all tables count
/// the same primitives). One true label a primitive, -1 where there is none.
std::vector<LabelTable> label_tables(const MatrixFView& features,
                                     std::span<const CorpusPrimitive> primitives,
                                     std::span<const int32_t> true_labels, int32_t label_count,
                                     std::span<const int64_t> known_clips,
                                     const LabelTransferOptions& options, int threads);

}  // namespace kinetome
