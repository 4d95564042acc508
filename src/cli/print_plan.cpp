#include "print_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinetome/store/json_text.h"

namespace kinetome::cli {
namespace {

constexpr uint64_t mebibyte = 1 << 20;

double mebibytes(uint64_t bytes) {
    return static_cast<double>(bytes) / static_cast<double>(mebibyte);
}

uint64_t whole_mebibytes(uint64_t bytes) {
    return (bytes + mebibyte - 1) / mebibyte;
}

void print_corpus(const RunEstimate& estimate) {
    fmt::print("takes       {} claim {} frames", estimate.takes, estimate.frames);
    if (estimate.left_out) fmt::print("; {} cannot be indexed", estimate.left_out);
    fmt::print("\n");
    for (const ClassEstimate& one : estimate.classes) {
        fmt::print("class       {}: {} takes, {} frames\n", one.name, one.takes, one.frames);
    }
    fmt::print("partitions  {}; the largest has {} frames, the most clusters are {}\n",
               estimate.partitions, estimate.largest_partition, estimate.most_clusters);
    fmt::print("rates       {}\n", estimate.rates_source);
    fmt::print("threads     {} at each of {} rank{}\n", estimate.threads, estimate.ranks,
               estimate.ranks == 1 ? "" : "s");
}

void print_stages(const RunEstimate& estimate) {
    fmt::print("{:<16} {:>5} {:>7} {:>11} {:>11} {:>11} {:>11}\n", "stage", "make", "reuse",
               "frames", "wall s", "peak MiB", "files MiB");
    uint64_t bytes = 0;
    for (const StageEstimate& stage : estimate.stages) {
        bytes += stage.bytes;
        fmt::print("{:<16} {:>5} {:>7} {:>11} {:>11.2f} {:>11.1f} {:>11.1f}\n", stage.name,
                   stage.to_make, stage.reused, stage.frames, stage.seconds,
                   mebibytes(stage.peak_bytes), mebibytes(stage.bytes));
    }
    fmt::print("{:<16} {:>5} {:>7} {:>11} {:>11.2f} {:>11.1f} {:>11.1f}\n", "whole run", "", "", "",
               estimate.seconds, mebibytes(estimate.peak_bytes), mebibytes(bytes));
}

void print_disk(const RunEstimate& estimate) {
    fmt::print("disk        {:.1f} MiB in {} files to write; {:.1f} MiB",
               mebibytes(estimate.need.bytes), estimate.need.inodes,
               mebibytes(estimate.free.bytes));
    if (estimate.free.inodes) fmt::print(" and {} inodes", *estimate.free.inodes);
    fmt::print(" are free\n");
}

void print_ranks(const RunEstimate& estimate) {
    fmt::print("ranks       {:>9}\n", "wall s");
    for (const RankSeconds& row : estimate.by_ranks) {
        fmt::print("{:>5}       {:>9.2f}\n", row.ranks, row.seconds);
    }
    if (estimate.helpful_ranks == 1) {
        fmt::print("more than 1 rank does not help\n");
    } else {
        fmt::print("up to {} ranks help\n", estimate.helpful_ranks);
    }
}

/// HH:MM:SS: three times the estimate and what starting takes, in whole minutes.
std::string time_limit(double seconds) {
    constexpr double margin = 3, start_minutes = 5;
    const auto minutes = static_cast<int64_t>(std::ceil(margin * seconds / 60 + start_minutes));
    return fmt::format("{:02}:{:02}:00", minutes / 60, minutes % 60);
}

/// Half as much again, and no less than a process needs that reads and writes files.
uint64_t memory_limit_mebibytes(uint64_t bytes) {
    constexpr uint64_t least = 512;
    return std::max(least, whole_mebibytes(bytes + bytes / 2));
}

}  // namespace

void print_plan_text(const RunEstimate& estimate) {
    print_corpus(estimate);
    fmt::print("\n");
    print_stages(estimate);
    fmt::print("\n");
    print_disk(estimate);
    print_ranks(estimate);
}

void print_plan_json(const RunEstimate& estimate) {
    Json classes = Json::array(), stages = Json::array(), ranks = Json::array();
    for (const ClassEstimate& one : estimate.classes) {
        classes.push_back({{"name", one.name}, {"takes", one.takes}, {"frames", one.frames}});
    }
    for (const StageEstimate& stage : estimate.stages) {
        stages.push_back({{"name", stage.name},
                          {"make", stage.to_make},
                          {"reuse", stage.reused},
                          {"frames", stage.frames},
                          {"seconds", stage.seconds},
                          {"peak_bytes", stage.peak_bytes},
                          {"bytes", stage.bytes}});
    }
    for (const RankSeconds& row : estimate.by_ranks) {
        ranks.push_back({{"ranks", row.ranks}, {"seconds", row.seconds}});
    }
    const FreeSpace& free = estimate.free;
    const JobEstimate& job = estimate.job;
    const Json json = {{"takes", estimate.takes},
                       {"left_out", estimate.left_out},
                       {"frames", estimate.frames},
                       {"classes", classes},
                       {"partitions", estimate.partitions},
                       {"largest_partition_frames", estimate.largest_partition},
                       {"most_clusters", estimate.most_clusters},
                       {"rates", estimate.rates_source},
                       {"threads", estimate.threads},
                       {"ranks", estimate.ranks},
                       {"stages", stages},
                       {"seconds", estimate.seconds},
                       {"peak_bytes", estimate.peak_bytes},
                       {"needed_bytes", estimate.need.bytes},
                       {"needed_inodes", estimate.need.inodes},
                       {"free_bytes", free.bytes},
                       {"free_inodes", free.inodes ? Json(*free.inodes) : Json()},
                       {"by_ranks", ranks},
                       {"helpful_ranks", estimate.helpful_ranks},
                       {"job",
                        {{"ingest_tasks", job.ingest_tasks},
                         {"ingest_seconds", job.ingest_seconds},
                         {"ingest_peak_bytes", job.ingest_bytes},
                         {"ranks", job.ranks},
                         {"seconds", job.seconds},
                         {"peak_bytes", job.bytes}}}};
    fmt::print("{}\n", dump_json(json, 1));
}

void print_plan_shell(const RunEstimate& estimate) {
    const JobEstimate& job = estimate.job;
    fmt::print("ingest_tasks={}\ningest_threads={}\ningest_memory_mb={}\ningest_time={}\n",
               job.ingest_tasks, estimate.threads, memory_limit_mebibytes(job.ingest_bytes),
               time_limit(job.ingest_seconds));
    fmt::print("ranks={}\nthreads={}\nmemory_mb={}\ntime={}\n", job.ranks, estimate.threads,
               memory_limit_mebibytes(job.bytes), time_limit(job.seconds));
    fmt::print("frames={}\ndisk_mb={}\n", estimate.frames, whole_mebibytes(estimate.need.bytes));
}

}  // namespace kinetome::cli
