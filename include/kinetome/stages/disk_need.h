// What a run will write, from the layout of its artifacts, against what the disk can hold.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "kinetome/run/generation.h"
#include "kinetome/stages/corpus_shape.h"
#include "kinetome/stages/execution.h"
#include "kinetome/stages/plan.h"
#include "kinetome/store/free_space.h"

namespace kinetome {

/// Bytes of an artifact that is not compressed. `cut` names its shard; "" for stages that make one
/// file. Nothing is known of stages without a layout here: 0.
uint64_t artifact_bytes(const std::string& stage, const std::string& cut, const CorpusShape& corpus,
                        const ReindexOptions& options);

/// Bytes of each artifact of a plan, by position in plan.work. What the last generation (or null)
/// took more or less than its layout, by compression for one, is expected again.
std::vector<uint64_t> planned_bytes(const RunPlan& plan, const CorpusShape& corpus,
                                    const Generation* last);

struct DiskNeed {
    uint64_t bytes = 0;
    uint64_t inodes = 0;  ///< files and folders

    bool operator==(const DiskNeed&) const = default;
};

/// What is written until the work at these positions of plan.work is made and published: artifacts,
/// receipts, checkpoints and the texts of a generation. Scratch and generation share files by
/// links unless `copies`. Nothing when there is nothing to make.
DiskNeed disk_need(const RunPlan& plan, const CorpusShape& corpus,
                   const std::vector<uint64_t>& planned_bytes, const std::vector<size_t>& to_make,
                   bool copies);

/// Throws CreateError with both numbers when the disk of the store cannot hold it.
void require_room(const std::filesystem::path& store, const DiskNeed& need, const FreeSpace& free);

}  // namespace kinetome
