// What each stage has to do for a corpus, in seconds of one thread.
#pragma once

#include <map>
#include <string>

#include "kinetome/run/generation.h"
#include "kinetome/stages/corpus_shape.h"
#include "kinetome/stages/rank_schedule.h"
#include "kinetome/stages/rates.h"

namespace kinetome {

/// One artifact of a sharded stage.
LoadItem shard_item(const std::string& stage, const std::string& cut, const CorpusShape& corpus,
                    const ReindexOptions& options, const Rates& rates);

/// A stage as a whole; its items are shards in order of their cuts, or partitions.
StageLoad stage_load(const std::string& stage, const CorpusShape& corpus,
                     const ReindexOptions& options, const Rates& rates);

/// What a stage of a generation took as a multiple of what the rates say of it; nothing for stages
/// that it does not hold, or when its options cannot be read. Of a piece of work that went on after
/// a kill the ledger tells only the rest, so that less than a quarter is not believed.
std::map<std::string, double> second_corrections(const Generation& generation, const Rates& rates);

}  // namespace kinetome
