// How much memory a rank needs at most while a stage is made.
#pragma once

#include <cstdint>
#include <string>

#include "kinetome/base/resources.h"
#include "kinetome/stages/corpus_shape.h"

namespace kinetome {

/// Highest resident size, of which rows that are only kept for speed are given up when `resources`
/// grant less. Throws UsageError when there is no such stage.
uint64_t peak_memory(const std::string& stage, const CorpusShape& corpus,
                     const ReindexOptions& options, const Resources& resources, int ranks);

}  // namespace kinetome
