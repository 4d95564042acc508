#include "kinetome/run/shard_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "kinetome/base/digest.h"
#include "kinetome/base/error.h"

using namespace kinetome;

namespace {

std::vector<ClipExtent> clips_named(const std::vector<std::string>& names, int64_t frames) {
    std::vector<ClipExtent> clips;
    for (const std::string& name : names) clips.push_back({hash_name(name), frames, 0});
    return clips;
}

std::vector<std::string> many_names(int count) {
    std::vector<std::string> names;
    for (int i = 0; i < count; ++i) names.push_back(fmt::format("take_{:05}", i));
    return names;
}

/// Shards as the names they hold: what a file's content depends on.
std::vector<std::set<std::string>> contents(const std::vector<std::string>& names, int64_t frames,
                                            int64_t shard_frames) {
    std::vector<std::set<std::string>> result;
    for (const Shard& shard : plan_shards(clips_named(names, frames), shard_frames)) {
        std::set<std::string>& content = result.emplace_back();
        for (const size_t i : shard.clips) content.insert(names[i]);
    }
    return result;
}

}  // namespace

TEST_CASE("every clip is in exactly one shard, in order", "[shard_plan]") {
    const auto clips = clips_named(many_names(2000), 1500);
    size_t next = 0;
    std::set<std::string> cuts;
    for (const Shard& shard : plan_shards(clips, 65'536)) {
        CHECK(cuts.insert(shard.cut).second);
        CHECK(shard.claimed_frames == static_cast<int64_t>(shard.clips.size()) * 1500);
        for (const size_t i : shard.clips) CHECK(i == next++);
    }
    CHECK(next == clips.size());
}

TEST_CASE("shards are about as large as asked", "[shard_plan]") {
    const auto clips = clips_named(many_names(20'000), 1500);
    const auto shards = plan_shards(clips, 65'536);
    const double mean = 20'000.0 * 1500 / static_cast<double>(shards.size());
    CHECK(mean > 0.8 * 65'536);
    CHECK(mean < 1.25 * 65'536);
}

TEST_CASE("one new take leaves all shards but its own as they were", "[shard_plan]") {
    const auto names = many_names(3000);
    for (const char* added : {"take_00000a", "take_01499a", "take_02999a", "a", "z"}) {
        auto more = names;
        more.insert(std::upper_bound(more.begin(), more.end(), added), added);
        const auto before = contents(names, 1500, 65'536), after = contents(more, 1500, 65'536);
        std::vector<std::set<std::string>> altered;
        for (const auto& shard : after) {
            if (std::find(before.begin(), before.end(), shard) == before.end()) {
                altered.push_back(shard);
            }
        }
        // Two when the new take happens to be a cut: it splits its shard.
        CHECK(altered.size() >= 1);
        CHECK(altered.size() <= 2);
    }
}

TEST_CASE("a small shard never straddles a large one: shards are whole groups", "[shard_plan]") {
    const auto names = many_names(3000);
    const auto large = contents(names, 1500, 65'536);
    for (const auto& small : contents(names, 1500, 8192)) {
        const auto holder = std::find_if(large.begin(), large.end(), [&](const auto& shard) {
            return shard.count(*small.begin()) > 0;
        });
        REQUIRE(holder != large.end());
        CHECK(std::includes(holder->begin(), holder->end(), small.begin(), small.end()));
    }
}

TEST_CASE("shards below the size of a group are refused", "[shard_plan]") {
    CHECK_THROWS_AS(plan_shards(clips_named({"a"}, 10), group_frames - 1), UsageError);
}

TEST_CASE("slices share out all shards, none twice, also when they are more than the shards",
          "[shard_plan]") {
    const auto shards = plan_shards(clips_named(many_names(500), 1500), 65'536);
    for (const int64_t count : {1, 2, 3, 7, 400}) {
        std::vector<int> taken(shards.size());
        for (int64_t i = 1; i <= count; ++i) {
            for (const size_t shard : shards_of_slice(shards, {i, count})) ++taken[shard];
        }
        CHECK(std::count(taken.begin(), taken.end(), 1) == static_cast<int64_t>(shards.size()));
    }
}

TEST_CASE("slices are about equally large", "[shard_plan]") {
    const auto shards = plan_shards(clips_named(many_names(5000), 1500), 8192);
    for (int64_t i = 1; i <= 4; ++i) {
        int64_t frames = 0;
        for (const size_t s : shards_of_slice(shards, {i, 4})) frames += shards[s].claimed_frames;
        CHECK(frames > 0.9 * 5000 * 1500 / 4);
        CHECK(frames < 1.1 * 5000 * 1500 / 4);
    }
}

TEST_CASE("slices that make no sense are refused", "[shard_plan]") {
    for (const char* text : {"", "1", "0/3", "4/3", "-1/3", "a/3", "1/", "/3", "1/3x", "1/0"}) {
        CAPTURE(text);
        CHECK_THROWS_AS(parse_slice(text), UsageError);
    }
    CHECK(parse_slice("3/8").index == 3);
    CHECK(parse_slice("3/8").count == 8);
}
