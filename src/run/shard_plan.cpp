#include "kinetome/run/shard_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "kinetome/base/error.h"

namespace kinetome {

std::vector<Shard> plan_shards(std::span<const ClipExtent> clips, int64_t shard_frames) {
    if (shard_frames < group_frames) {
        throw UsageError(fmt::format("--shard-frames {} is too small: the least is {}",
                                     shard_frames, group_frames));
    }
    std::vector<Shard> shards;
    Shard shard;
    for (size_t i = 0; i < clips.size(); ++i) {
        shard.clips.push_back(i);
        shard.claimed_frames += clips[i].claimed;
        if (cut_after(clips[i], shard_frames)) {
            shard.cut = fmt::format("{:016x}", clips[i].name_hash);
            shards.push_back(std::exchange(shard, {}));
        }
    }
    if (!shard.clips.empty()) {
        shard.cut = "last";
        shards.push_back(std::move(shard));
    }
    return shards;
}

Slice parse_slice(const std::string& text) {
    Slice slice;
    const size_t slash = text.find('/');
    const auto number = [](std::string_view digits, int64_t& value) {
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), value);
        return error == std::errc() && end == digits.data() + digits.size() && !digits.empty();
    };
    const std::string_view view = text;
    if (slash == std::string::npos || !number(view.substr(0, slash), slice.index) ||
        !number(view.substr(slash + 1), slice.count) || slice.index < 1 ||
        slice.index > slice.count) {
        throw UsageError(
            fmt::format("--slice {}: expected i/n with 1 <= i <= n, such as 3/8", text));
    }
    return slice;
}

std::vector<size_t> shards_of_slice(std::span<const Shard> shards, const Slice& slice) {
    int64_t total = 0;
    for (const Shard& shard : shards) total += shard.claimed_frames;
    std::vector<size_t> chosen;
    int64_t before = 0;
    for (size_t i = 0; i < shards.size(); ++i) {
        // Twice the middle, so that it stays whole; clips without frames go to the first slice.
        const int64_t middle = 2 * before + shards[i].claimed_frames;
        const int64_t part = total ? middle * slice.count / (2 * total) : 0;
        if (std::min(part, slice.count - 1) == slice.index - 1) chosen.push_back(i);
        before += shards[i].claimed_frames;
    }
    return chosen;
}

}  // namespace kinetome
