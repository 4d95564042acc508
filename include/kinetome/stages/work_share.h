// Which rank works on what: large partitions all together, piece by piece, small ones and shards
// one rank each. The results do not depend on it.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/packing.h"
#include "kinetome/stages/pose_rows.h"

namespace kinetome {

/// Stands for all ranks.
inline constexpr int all_ranks = -1;

/// For each amount of work (frames of a partition, of a shard): all_ranks where it is more than a
/// rank's part of the whole and `together` allows that, else the rank with the least to do, largest
/// amounts first, ties to the first rank.
std::vector<int> share_out(const std::vector<int64_t>& amounts, int rank_count, bool together);

/// work(partition number, workers) of every partition, each by its workers; results in partition
/// order at rank 0, none at the others.
template <class Result, class Work>
std::vector<Result> for_partitions(const Workers& workers,
                                   const std::vector<PosePartition>& partitions, Work&& work) {
    std::vector<int64_t> amounts;
    for (const PosePartition& partition : partitions) amounts.push_back(partition.rows());
    const std::vector<int> owners = share_out(amounts, workers.rank_count(), true);

    std::vector<Result> results(partitions.size());
    for (size_t i = 0; i < partitions.size(); ++i) {
        if (owners[i] == all_ranks) results[i] = work(i, workers);
    }
    for (size_t i = 0; i < partitions.size(); ++i) {
        if (owners[i] != workers.rank()) continue;
        if (workers.ranks) workers.ranks->check();
        results[i] = work(i, workers.alone());
    }
    if (workers.rank_count() == 1) return results;

    Packer mine;
    for (size_t i = 0; i < partitions.size() && !workers.is_root(); ++i) {
        if (owners[i] == workers.rank()) pack(mine, results[i]);
    }
    const std::vector<std::string> brought = workers.ranks->gather(mine.take());
    if (!workers.is_root()) return {};
    for (int rank = 1; rank < workers.rank_count(); ++rank) {
        Unpacker in(brought[static_cast<size_t>(rank)]);
        for (size_t i = 0; i < partitions.size(); ++i) {
            if (owners[i] == rank) unpack(in, results[i]);
        }
    }
    return results;
}

}  // namespace kinetome
