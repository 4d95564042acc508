#include "kinetome/base/piece_sum.h"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "support/thread_ranks.h"
#include "tree_reference.h"

using namespace kinetome;
using namespace kinetome::test;

namespace {

std::vector<ClipExtent> some_clips() {
    RandomStream random(1, "clips");
    std::vector<ClipExtent> clips;
    for (int i = 0; i < 120; ++i) {
        const auto frames = int64_t(1 + random.below(2500));
        clips.push_back({random(), frames, i % 5 == 0 ? 0 : frames});
    }
    clips[60] = {0, group_frames, 0};  // between two cuts: a group without rows
    clips[59].claimed = group_frames;
    return clips;
}

void pause_now_and_then(int64_t item) {
    if (item % 3 == 0) std::this_thread::sleep_for(std::chrono::microseconds(100 * (item % 7)));
}

}  // namespace

TEST_CASE("sums over pieces have the same bits for 1, 2, 3 and 7 threads") {
    const PieceLayout layout = layout_pieces(some_clips());
    REQUIRE(layout.group_count() > 10);
    const auto values = sensitive_values(size_t(layout.rows()));
    const auto leaf = [&](const RowRange& rows) {
        pause_now_and_then(rows.first);
        return std::accumulate(values.begin() + rows.first, values.begin() + rows.end, 0.0);
    };

    // The same tree by its definition: pieces in groups, groups above, empty ones in their place.
    std::vector<std::optional<double>> groups;
    for (size_t g = 0; g + 1 < layout.group_first.size(); ++g) {
        std::vector<double> leaves;
        for (int64_t p = layout.group_first[g]; p < layout.group_first[g + 1]; ++p) {
            leaves.push_back(leaf(layout.pieces[size_t(p)]));
        }
        groups.push_back(leaves.empty() ? std::nullopt : std::optional(tree_sum(leaves, add)));
    }
    REQUIRE(std::count(groups.begin(), groups.end(), std::nullopt) > 0);
    const auto expected = tree_sum(groups, [](std::optional<double>& left, const auto& right) {
        if (left && right) {
            *left += *right;
        } else if (right) {
            left = right;
        }
    });

    for (const int threads : {1, 2, 3, 7}) {
        for (int repeat = 0; repeat < 3; ++repeat) {
            CHECK(sum_pieces<double>(threads, layout, leaf, add) == expected);
        }
    }
    // The values can tell: another order gives other bits.
    CHECK(std::accumulate(values.begin(), values.end(), 0.0) != *expected);
}

TEST_CASE("a sum over nothing is nothing") {
    const auto leaf = [](const RowRange& rows) { return double(rows.size()); };
    CHECK_FALSE(sum_pieces<double>(3, layout_rows(0), leaf, add));
    std::vector<ClipExtent> without_rows = some_clips();
    for (ClipExtent& clip : without_rows) clip.rows = 0;
    CHECK_FALSE(sum_pieces<double>(3, layout_pieces(without_rows), leaf, add));
}

TEST_CASE("an exception in a piece leaves the sum") {
    const auto leaf = [](const RowRange& rows) -> double {
        if (rows.first >= 3 * piece_frames) throw std::runtime_error(std::to_string(rows.first));
        return 0;
    };
    for (const int threads : {1, 2, 3, 7}) {
        CHECK_THROWS_WITH(sum_pieces<double>(threads, layout_rows(20 * piece_frames), leaf, add),
                          std::to_string(3 * piece_frames));
    }
}

TEST_CASE("every piece is in exactly one rank's share, in order") {
    for (const PieceLayout& layout :
         {layout_pieces(some_clips()), layout_rows(0), layout_rows(5)}) {
        for (const int ranks : {1, 2, 3, 7, 100}) {
            std::vector<int> owners(layout.pieces.size(), 0);
            for (int rank = 0; rank < ranks; ++rank) {
                const auto share = share_of_pieces(layout, rank, ranks);
                CHECK(std::is_sorted(share.begin(), share.end()));
                for (const int64_t piece : share) ++owners.at(size_t(piece));
            }
            CHECK(owners == std::vector<int>(owners.size(), 1));
        }
    }
}

TEST_CASE("shares differ by less than two pieces of rows a run") {
    const PieceLayout layout = layout_pieces(some_clips());
    for (int rank = 0; rank < 4; ++rank) {
        int64_t rows = 0;
        for (const int64_t piece : share_of_pieces(layout, rank, 4)) {
            rows += layout.pieces[size_t(piece)].size();
        }
        CHECK(std::abs(rows - layout.rows() / 4) < 4 * piece_frames);
    }
}

TEST_CASE("rows that make more and more work along the corpus are shared out evenly") {
    const PieceLayout layout = layout_rows(400 * piece_frames);
    for (const int ranks : {2, 3, 5}) {
        double whole = 0;
        std::vector<double> work(static_cast<size_t>(ranks));
        for (int rank = 0; rank < ranks; ++rank) {
            for (const int64_t piece : share_of_pieces(layout, rank, ranks)) {
                work[size_t(rank)] += double(piece);
                whole += double(piece);
            }
        }
        for (const double of_rank : work) CHECK(of_rank == Approx(whole / ranks).epsilon(0.02));
    }
}

TEST_CASE("few pieces are still one for each rank") {
    for (const int ranks : {2, 3, 7}) {
        const PieceLayout layout = layout_rows(ranks * piece_frames);
        for (int rank = 0; rank < ranks; ++rank) {
            CHECK(share_of_pieces(layout, rank, ranks) == std::vector<int64_t>{rank});
        }
    }
}

TEST_CASE("sums over pieces have the same bits for any number of ranks, at every rank") {
    const PieceLayout layout = layout_pieces(some_clips());
    const auto values = sensitive_values(size_t(layout.rows()));
    const auto leaf = [&](const RowRange& rows) {
        return std::accumulate(values.begin() + rows.first, values.begin() + rows.end, 0.0);
    };
    const auto expected = sum_pieces<double>(1, layout, leaf, add);
    REQUIRE(expected);
    for (const int count : {1, 2, 3, 5, 60}) {  // the last: more ranks than pieces with rows
        std::vector<std::optional<double>> sums(static_cast<size_t>(count));
        run_as_ranks(count, [&](Communicator& ranks) {
            sums[size_t(ranks.rank())] = sum_pieces<double>(Workers(2, &ranks), layout, leaf, add);
        });
        for (const auto& sum : sums) CHECK(sum == expected);
    }
}

TEST_CASE("pieces of a rank that is held up are summed by the others on its machine") {
    const PieceLayout layout = layout_rows(40 * piece_frames);
    std::atomic<int> summed{0};
    std::atomic<bool> held_up{false}, others_helped{false};
    std::vector<std::optional<double>> sums(3);
    run_as_ranks(3, [&](Communicator& ranks) {
        const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
        const auto leaf = [&](const RowRange& rows) {
            if (ranks.rank() == 0) {
                // At its first piece, until all others are summed: with help they are.
                if (!held_up.exchange(true)) {
                    for (int turn = 0; summed < 39 && turn < 20'000; ++turn) pause();
                    others_helped = summed == 39;
                }
            } else {
                while (!held_up) pause();  // else they may be done before rank 0 puts its share up
            }
            ++summed;
            return double(rows.size());
        };
        sums[size_t(ranks.rank())] = sum_pieces<double>(Workers(1, &ranks), layout, leaf, add);
    });
    CHECK(others_helped);
    CHECK(summed == 40);
    for (const auto& sum : sums) CHECK(sum == 40.0 * piece_frames);
}

TEST_CASE("an item of a work list is taken once, from whichever end") {
    WorkList list;
    CHECK_FALSE(list.take_front());
    list.refill(20'000);
    std::vector<std::atomic<int>> taken(20'000);
    {
        std::vector<std::jthread> takers;
        for (int t = 0; t < 4; ++t) {
            takers.emplace_back([&, t] {
                while (const auto item = t % 2 ? list.take_back() : list.take_front()) {
                    ++taken.at(size_t(*item));
                }
            });
        }
    }
    CHECK(std::all_of(taken.begin(), taken.end(), [](const auto& count) { return count == 1; }));
    CHECK(list.left() == 0);
    list.refill(2);
    CHECK(list.take_back() == 1);
    CHECK(list.take_front() == 0);
    CHECK_FALSE(list.take_back());
}

TEST_CASE("a sum over nothing is nothing at every rank") {
    run_as_ranks(3, [&](Communicator& ranks) {
        const auto leaf = [](const RowRange& rows) { return double(rows.size()); };
        std::vector<ClipExtent> without_rows = some_clips();
        for (ClipExtent& clip : without_rows) clip.rows = 0;
        for (const PieceLayout& layout : {layout_rows(0), layout_pieces(without_rows)}) {
            if (sum_pieces<double>(Workers(1, &ranks), layout, leaf, add)) {
                throw std::logic_error("a sum came from nowhere");
            }
        }
    });
}

TEST_CASE("an exception at one rank ends the sum at all") {
    const auto outcomes = outcomes_of_ranks(3, [](Communicator& ranks) {
        const auto leaf = [&](const RowRange&) -> double {
            if (ranks.rank() == 1) throw StoreError("unreadable");
            return 0;
        };
        sum_pieces<double>(Workers(1, &ranks), layout_rows(20 * piece_frames), leaf, add);
    });
    for (size_t rank = 0; rank < 3; ++rank) {
        REQUIRE(outcomes[rank].thrown);
        CHECK(outcomes[rank].is_news == (rank != 1));
    }
    CHECK_THROWS_WITH(std::rethrow_exception(outcomes[0].thrown), "rank 1: unreadable");
}
