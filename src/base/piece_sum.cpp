#include "kinetome/base/piece_sum.h"

#include <algorithm>
#include <utility>

namespace kinetome {

int64_t runs_per_rank(int64_t pieces, int rank_count) {
    constexpr int64_t most_runs = 2, least_pieces = 4;
    return rank_count == 1
               ? 1
               : std::clamp<int64_t>(pieces / (rank_count * least_pieces), 1, most_runs);
}

std::vector<int64_t> share_of_pieces(const PieceLayout& layout, int rank, int rank_count) {
    const auto& pieces = layout.pieces;
    const int64_t rounds = runs_per_rank(static_cast<int64_t>(pieces.size()), rank_count);
    const int64_t runs = rounds * rank_count;
    // The first piece whose middle is at or beyond a run's part of the rows begins it.
    const auto begin_of = [&](int64_t run) {
        const auto at = std::partition_point(pieces.begin(), pieces.end(), [&](const RowRange& p) {
            return (p.first + p.end) * runs < 2 * layout.rows() * run;
        });
        return static_cast<int64_t>(at - pieces.begin());
    };
    std::vector<int64_t> share;
    for (int64_t round = 0; round < rounds; ++round) {
        const int64_t place = round % 2 == 0 ? rank : rank_count - 1 - rank;
        const int64_t run = round * rank_count + place;
        for (int64_t p = begin_of(run); p < begin_of(run + 1); ++p) share.push_back(p);
    }
    return share;
}

SharedPieces::SharedPieces(const PieceLayout& layout, const Workers& workers) {
    const auto lists = workers.ranks ? workers.ranks->work_lists() : std::vector<WorkList*>();
    for (int rank = 0; rank < workers.rank_count(); ++rank) {
        const bool is_own = rank == workers.rank();
        WorkList* const list = lists.empty() ? nullptr : lists[static_cast<size_t>(rank)];
        if (!list && !is_own) continue;
        Share share{list ? list : &unshared_, share_of_pieces(layout, rank, workers.rank_count())};
        most_ += static_cast<int64_t>(share.pieces.size());
        if (is_own) {
            own_ = std::move(share);
        } else {
            others_.push_back(std::move(share));
        }
    }
    own_.left->refill(static_cast<int64_t>(own_.pieces.size()));
}

std::optional<int64_t> SharedPieces::take() {
    if (const auto item = own_.left->take_front()) return own_.piece(*item);
    for (;;) {
        const auto most_left = std::max_element(
            others_.begin(), others_.end(),
            [](const Share& a, const Share& b) { return a.left->left() < b.left->left(); });
        if (most_left == others_.end() || most_left->left->left() <= 0) return std::nullopt;
        if (const auto item = most_left->left->take_back()) return most_left->piece(*item);
    }
}

}  // namespace kinetome
