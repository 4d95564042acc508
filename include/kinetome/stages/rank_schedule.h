// How long work takes when ranks share it, by the rules that the stages share it by.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace kinetome {

/// A file of a shard, or a partition.
struct LoadItem {
    int64_t amount = 0;          ///< frames: what it is shared out by
    double seconds = 0;          ///< of one thread
    double fixed_seconds = 0;    ///< beside those, however many threads: opening, syncing, hashing
    int64_t pieces = 1;          ///< that threads, and ranks where they may, work on side by side
    double exchanged_bytes = 0;  ///< that a rank hands over when ranks share the item
};

/// What is to be made in one stage.
struct StageLoad {
    std::vector<LoadItem> items;
    double serial_share = 0;  ///< of an item's time, that more threads do not shorten
    /// Whether all ranks work together on an item that is more than a rank's share of the whole.
    bool shares_items = false;
};

/// As share_out gives the items to ranks: all together those that are too large for one, one after
/// another, then each rank its own.
double load_seconds(const StageLoad& load, int threads, int ranks);

struct RankSeconds {
    int ranks = 1;
    double seconds = 0;

    bool operator==(const RankSeconds&) const = default;
};

/// 1, 2, 4, 8, … ranks, up to the first count that gains less than a tenth over the one before;
/// that count is the last row. No more than most_ranks.
std::vector<RankSeconds> tabulate_ranks(const std::function<double(int ranks)>& seconds,
                                        int most_ranks = 1024);
/// The largest count of the table that still gains a tenth.
int ranks_that_help(const std::vector<RankSeconds>& table);

}  // namespace kinetome
