// Items that are each worked on by one rank, with what came of them at all.
#pragma once

#include <cstdint>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/packing.h"
#include "kinetome/base/parallel.h"

namespace kinetome {

/// work(i) of each item of [0, n), by item, at every rank. Ranks take turns, so that neighbouring
/// items, which cost alike, go to different ones; the threads of a rank share its own.
template <class Result, class Work>
std::vector<Result> shared_items(int64_t n, const Workers& workers, const Work& work) {
    const int64_t ranks = workers.rank_count(), rank = workers.rank();
    std::vector<Result> results(static_cast<size_t>(n));
    parallel_for(workers.threads, (n - rank + ranks - 1) / ranks, [&](int64_t turn) {
        const int64_t item = rank + turn * ranks;
        results[static_cast<size_t>(item)] = work(item);
    });
    if (ranks == 1) return results;
    Packer mine;
    for (int64_t item = rank; item < n; item += ranks)
        pack(mine, results[static_cast<size_t>(item)]);
    int64_t first = 0;
    for (std::string& bytes : workers.ranks->gather_to_all(mine.take())) {
        Unpacker in(std::move(bytes));
        for (int64_t item = first; item < n; item += ranks)
            unpack(in, results[static_cast<size_t>(item)]);
        ++first;
    }
    return results;
}

}  // namespace kinetome
