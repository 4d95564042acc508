// Reach tables made when they are asked for, several at once, and kept as far as memory allows.
#pragma once

#include <tbb/task_arena.h>

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/models/reach_table.h"

namespace kinetome {

/// What finding bundles may use; results do not depend on it.
struct BundleResources {
    int threads = 1;
    uint64_t table_bytes = uint64_t{512}
                           << 20U;  ///< that reach tables kept from round to round take
    Communicator* ranks = nullptr;  ///< that find the same bundles by the same calls
    size_t least_shared =
        256;  ///< substrings to spread from that are worth a message between ranks
};

template <int Words>
class ReachTables {
  public:
    ReachTables(const MatchingContext& context, const BundleResources& resources);

    /// Makes what the rows of these substrings need, in parallel. Tables that were made longest ago
    /// are given up first when the budget is exceeded, those just asked for are not.
    void prepare(std::span<const Substring> wanted);
    /// Columns and starts of substrings that match this one, as of when it was prepared.
    std::span<const ReachCell<Words>> matches(const Substring& substring) const;
    /// What the tables kept take.
    uint64_t bytes() const { return bytes_; }

  private:
    struct Request {
        int32_t first = 0, last = 0;
    };
    std::vector<Request> missing(std::span<const Substring> wanted) const;
    void evict(std::span<const Substring> wanted);

    const MatchingContext& context_;
    uint64_t most_bytes_;
    uint64_t bytes_ = 0;
    std::vector<std::unique_ptr<ReachTable<Words>>> tables_;  ///< by first letter
    std::deque<int32_t> made_;                                ///< first letters, oldest first
    std::unique_ptr<tbb::task_arena> arena_;                  ///< none on one thread
};

}  // namespace kinetome
