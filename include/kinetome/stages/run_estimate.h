// What a run would cost before it is begun: seconds, bytes, memory, and how many ranks help.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinetome/stages/disk_need.h"
#include "kinetome/stages/rank_schedule.h"
#include "kinetome/stages/rates.h"
#include "kinetome/stages/reindex.h"

namespace kinetome {

struct StageEstimate {
    std::string name;
    int64_t to_make = 0;  ///< artifacts
    int64_t reused = 0;
    int64_t frames = 0;  ///< in what is to be made
    double seconds = 0;
    uint64_t bytes = 0;       ///< of what is to be made
    uint64_t peak_bytes = 0;  ///< at a rank; 0 when there is nothing to make
};

struct ClassEstimate {
    std::string name;
    int64_t takes = 0;
    int64_t frames = 0;
};

/// What to ask a scheduler for, without any margin.
struct JobEstimate {
    int ingest_tasks = 1;       ///< of an array, a slice each
    double ingest_seconds = 0;  ///< of the longest task
    uint64_t ingest_bytes = 0;  ///< of memory
    int ranks = 1;              ///< of the job that does the rest
    double seconds = 0;
    uint64_t bytes = 0;  ///< of memory at a rank
};

struct RunEstimate {
    int64_t takes = 0;
    int64_t left_out = 0;  ///< takes that cannot be indexed
    int64_t frames = 0;    ///< that the others claim
    std::vector<ClassEstimate> classes;
    int64_t partitions = 0;
    int64_t largest_partition = 0;  ///< frames
    int64_t most_clusters = 0;      ///< κ of a partition

    int ranks = 1;
    int threads = 1;           ///< a rank
    std::string rates_source;  ///< where the constants of the seconds come from
    std::vector<StageEstimate> stages;
    double seconds = 0;
    uint64_t peak_bytes = 0;
    std::vector<RankSeconds> by_ranks;
    int helpful_ranks = 1;

    DiskNeed need;
    FreeSpace free;
    JobEstimate job;
};

struct EstimateRequest {
    ReindexRequest run;
    std::optional<int> ranks;     ///< else those that help in a job; one for everything else
    std::filesystem::path rates;  ///< file of rates; "": the last generation's, else those shipped
};

/// Finds what is finished of what the survey asks for; writes nothing. The store need not exist.
/// What is finished costs nothing; survey, checks of what is there and publishing are not counted.
RunEstimate estimate_run(const EstimateRequest& request, Survey survey, const Log& log);

}  // namespace kinetome
