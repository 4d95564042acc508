#include "kinetome/base/pieces.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "kinetome/base/digest.h"
#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

ClipExtent clip(uint64_t number, int64_t frames) {
    return {hash_name("take_" + std::to_string(number)), frames, frames};
}

/// Clips of 1 to `longest` frames.
std::vector<ClipExtent> clips_of(int count, uint64_t longest, uint64_t seed = 1) {
    RandomStream random(seed, "clips");
    std::vector<ClipExtent> clips;
    for (int i = 0; i < count; ++i) {
        clips.push_back(clip(static_cast<uint64_t>(i), 1 + int64_t(random.below(longest))));
    }
    return clips;
}

std::vector<std::vector<uint64_t>> runs(const std::vector<ClipExtent>& clips, int64_t mean) {
    std::vector<std::vector<uint64_t>> runs(1);
    for (const ClipExtent& c : clips) {
        runs.back().push_back(c.name_hash);
        if (cut_after(c, mean)) runs.emplace_back();
    }
    if (runs.back().empty()) runs.pop_back();
    return runs;
}

int64_t total_rows(const std::vector<ClipExtent>& clips) {
    return std::accumulate(clips.begin(), clips.end(), int64_t{0},
                           [](int64_t sum, const ClipExtent& c) { return sum + c.rows; });
}

/// Rows at which a piece may end: the ends of blocks.
std::set<int64_t> block_ends(const std::vector<ClipExtent>& clips) {
    std::set<int64_t> ends;
    int64_t first = 0;
    for (const ClipExtent& c : clips) {
        for (int64_t row = piece_frames; row < c.rows; row += piece_frames)
            ends.insert(first + row);
        ends.insert(first += c.rows);
    }
    return ends;
}

}  // namespace

TEST_CASE("a cut at some mean is a cut at every smaller mean, so that shards are whole groups") {
    RandomStream random(1, "means");
    for (const ClipExtent& c : clips_of(20'000, 100'000)) {
        const int64_t mean = 1 + int64_t(random.below(200'000));
        const int64_t smaller = 1 + int64_t(random.below(uint64_t(mean)));
        if (cut_after(c, mean)) REQUIRE(cut_after(c, smaller));
    }
}

TEST_CASE("a clip is cut after with the chance of its frames to the mean") {
    for (const int64_t mean : {group_frames, int64_t{65'536}}) {
        const auto clips = clips_of(100'000, 12'000);
        double cuts = 0, expected = 0, variance = 0;
        for (const ClipExtent& c : clips) {
            const double chance = std::min(1.0, double(c.claimed) / double(mean));
            cuts += cut_after(c, mean);
            expected += chance;
            variance += chance * (1 - chance);
        }
        CAPTURE(mean, cuts, expected);
        CHECK(std::abs(cuts - expected) < 5 * std::sqrt(variance));
        CHECK(expected > 1000);
    }
}

TEST_CASE("runs of short clips have the mean asked for") {
    const auto clips = clips_of(100'000, 1000);
    const double run = double(total_rows(clips)) / double(runs(clips, group_frames).size());
    CHECK(run == Approx(double(group_frames)).epsilon(0.05));
}

TEST_CASE("a clip without frames never ends a run, one as long as the mean always does") {
    for (uint64_t number = 0; number < 1000; ++number) {
        CHECK_FALSE(cut_after(clip(number, 0), 1));
        CHECK_FALSE(cut_after(clip(number, -5), 1));
        CHECK(cut_after(clip(number, 100), 100));
        CHECK(cut_after(clip(number, 101), 100));
    }
}

TEST_CASE("a file that claims absurdly many frames does not overflow the cutting") {
    constexpr int64_t most = std::numeric_limits<int64_t>::max();
    int cuts = 0;
    for (uint64_t number = 0; number < 1000; ++number) {
        CHECK(cut_after(clip(number, most), most));
        cuts += cut_after(clip(number, most / 2), most);
    }
    CHECK(std::abs(cuts - 500) < 80);
}

TEST_CASE("a new clip alters one run of clips, whatever its place") {
    const auto clips = clips_of(400, 3000);
    const auto before = runs(clips, group_frames);
    const std::set<std::vector<uint64_t>> old_runs(before.begin(), before.end());
    REQUIRE(old_runs.size() > 20);
    for (size_t place = 0; place <= clips.size(); ++place) {
        auto more = clips;
        more.insert(more.begin() + static_cast<std::ptrdiff_t>(place), clip(1000 + place, 2500));
        const auto after = runs(more, group_frames);
        const auto altered = std::count_if(
            after.begin(), after.end(), [&](const auto& run) { return !old_runs.contains(run); });
        // The run it falls in, which it may also split in two.
        CHECK(altered >= 1);
        CHECK(altered <= 2);
        CHECK(after.size() <= before.size() + 1);
        CHECK(after.size() >= before.size());
    }
}

TEST_CASE("pieces hold every row once, in order, and end where blocks end") {
    for (const uint64_t longest : {3, 700, 2048, 9000}) {
        const auto clips = clips_of(300, longest);
        const PieceLayout layout = layout_pieces(clips);
        const auto ends = block_ends(clips);
        int64_t next = 0;
        for (const RowRange& piece : layout.pieces) {
            REQUIRE(piece.first == next);
            REQUIRE(piece.size() > 0);
            REQUIRE(piece.size() < 2 * piece_frames);
            REQUIRE(ends.contains(piece.end));
            next = piece.end;
        }
        CHECK(next == total_rows(clips));
        CHECK(layout.rows() == next);
        CHECK(layout.group_first.back() == int64_t(layout.pieces.size()));
        CHECK(std::is_sorted(layout.group_first.begin(), layout.group_first.end()));
    }
}

TEST_CASE("only the last piece of a group is short") {
    const PieceLayout layout = layout_pieces(clips_of(300, 3000));
    for (int64_t g = 0; g < layout.group_count(); ++g) {
        const int64_t end = layout.group_first[size_t(g) + 1];
        for (int64_t p = layout.group_first[size_t(g)]; p + 1 < end; ++p) {
            CHECK(layout.pieces[size_t(p)].size() >= piece_frames);
        }
    }
}

TEST_CASE("a layout made shard by shard is the layout of the whole, at any shard size") {
    auto clips = clips_of(600, 4000);
    for (size_t i = 0; i < clips.size(); i += 7) clips[i].rows = 0;  // quarantined ones
    const PieceLayout whole = layout_pieces(clips);
    REQUIRE(whole.group_count() > 50);
    for (const int64_t shard_frames : {group_frames, 3 * group_frames, int64_t{65'536}}) {
        PieceLayout joined;
        size_t first = 0, shards = 0;
        for (size_t i = 0; i < clips.size(); ++i) {
            if (!cut_after(clips[i], shard_frames) && i + 1 < clips.size()) continue;
            const PieceLayout shard = layout_pieces(std::span(clips).subspan(first, i + 1 - first));
            const int64_t rows = joined.rows(), pieces = int64_t(joined.pieces.size());
            for (const RowRange& p : shard.pieces) {
                joined.pieces.push_back({rows + p.first, rows + p.end});
            }
            for (size_t g = 1; g < shard.group_first.size(); ++g) {
                joined.group_first.push_back(pieces + shard.group_first[g]);
            }
            first = i + 1;
            ++shards;
        }
        CHECK(shards > 5);
        CHECK(joined.pieces == whole.pieces);
        CHECK(joined.group_first == whole.group_first);
    }
}

TEST_CASE("clips left out of a matrix keep their group's number") {
    auto clips = clips_of(300, 3000);
    const int64_t groups = layout_pieces(clips).group_count();
    for (ClipExtent& c : clips) c.rows = 0;
    const PieceLayout empty = layout_pieces(clips);
    CHECK(empty.group_count() == groups);
    CHECK(empty.pieces.empty());
    CHECK(empty.rows() == 0);
}

TEST_CASE("no clips make no groups, and a cut after the last clip makes no empty group") {
    CHECK(layout_pieces({}).group_count() == 0);
    const std::vector<ClipExtent> one{clip(1, group_frames)};
    CHECK(layout_pieces(one).group_count() == 1);
}

TEST_CASE("a long clip is cut into pieces that do not depend on the clips before it") {
    const std::vector<ClipExtent> clips{{.name_hash = 0, .claimed = 0, .rows = 100},
                                        {.name_hash = 0, .claimed = 0, .rows = 5000}};
    const std::vector<RowRange> expected{{0, 2148}, {2148, 4196}, {4196, 5100}};
    CHECK(layout_pieces(clips).pieces == expected);
}

TEST_CASE("a matrix without clips is one group of equal pieces and a rest") {
    const PieceLayout layout = layout_rows(2 * piece_frames + 5);
    const std::vector<RowRange> expected{{0, piece_frames},
                                         {piece_frames, 2 * piece_frames},
                                         {2 * piece_frames, 2 * piece_frames + 5}};
    CHECK(layout.pieces == expected);
    CHECK(layout.group_first == std::vector<int64_t>{0, 3});
    CHECK(layout_rows(0).group_count() == 0);
}
