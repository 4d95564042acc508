// Items that are each worked on by one rank, with what came of them at all.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/packing.h"
#include "kinetome/base/parallel.h"

namespace kinetome {

/// What came of each item, by item, at every rank: `results` holds those of this rank's turn, items
/// rank, rank + ranks and so on.
template <class Result>
void exchange_by_turns(std::vector<Result>& results, const Workers& workers) {
    const auto ranks = static_cast<size_t>(workers.rank_count());
    if (ranks == 1) return;
    Packer mine;
    for (auto item = static_cast<size_t>(workers.rank()); item < results.size(); item += ranks)
        pack(mine, results[item]);
    size_t first = 0;
    for (std::string& bytes : workers.ranks->gather_to_all(mine.take())) {
        Unpacker in(std::move(bytes));
        for (size_t item = first; item < results.size(); item += ranks) unpack(in, results[item]);
        ++first;
    }
}

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
    exchange_by_turns(results, workers);
    return results;
}

}  // namespace kinetome
