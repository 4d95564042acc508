// How a corpus is cut into shards: files of whole clips, cut where a hash of a clip's name says so,
// so that one new take alters one of them (design §3).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinetome/base/pieces.h"

namespace kinetome {

struct Shard {
    std::string cut;            ///< 16 hexadecimal digits of the clip that ends it, or "last"
    std::vector<size_t> clips;  ///< positions in the name-sorted list
    int64_t claimed_frames = 0;
};

/// Shards of `shard_frames` claimed frames on average, in clip order. Clips are in name order.
/// Throws UsageError when shard_frames is below group_frames: a shard must be whole groups.
std::vector<Shard> plan_shards(std::span<const ClipExtent> clips, int64_t shard_frames);

/// One of n nearly equal parts of the shards, for tasks of an array.
struct Slice {
    int64_t index = 1;  ///< 1 … count
    int64_t count = 1;
};

/// "3/8". Throws UsageError unless 1 <= i <= n.
Slice parse_slice(const std::string& text);

/// Shards whose middle frame falls into the slice: every shard is in exactly one slice.
std::vector<size_t> shards_of_slice(std::span<const Shard> shards, const Slice& slice);

}  // namespace kinetome
