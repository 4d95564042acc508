// Sums over the pieces of a layout, shared by threads and ranks: whoever adds up whatever, the bits
// are the same (design §5). A model describes its pieces; this is all it needs to run on a cluster.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/fixed_tree.h"
#include "kinetome/base/packing.h"
#include "kinetome/base/parallel.h"
#include "kinetome/base/pieces.h"

namespace kinetome {

/// Runs of consecutive pieces that a rank works on. The work a row makes changes slowly along a
/// corpus (takes of one subject lie together), so several runs a rank, from all over the corpus,
/// even it out; each run more makes more subtrees wait for siblings at other ranks.
int64_t runs_per_rank(int64_t pieces, int rank_count);

/// The pieces that a rank works on, in their order: runs of about equally many rows, dealt out to
/// the ranks back and forth. Every piece is in exactly one share; a rank may have none.
std::vector<int64_t> share_of_pieces(const PieceLayout& layout, int rank, int rank_count);

/// The pieces of a sum as a rank takes them: those of its own share first, in order, then those
/// that ranks on the same machine have not come to.
class SharedPieces {
  public:
    SharedPieces(const PieceLayout& layout, const Workers& workers);
    SharedPieces(const SharedPieces&) = delete;
    SharedPieces& operator=(const SharedPieces&) = delete;

    /// No more than so many pieces can come out.
    int64_t most() const { return most_; }
    /// Thread-safe; nothing when none is left.
    std::optional<int64_t> take();

  private:
    struct Share {
        WorkList* left;
        std::vector<int64_t> pieces;
        int64_t piece(int64_t item) const { return pieces[static_cast<size_t>(item)]; }
    };

    WorkList unshared_;  ///< of a rank that shares nothing
    Share own_{&unshared_, {}};
    std::vector<Share> others_;  ///< on this machine
    int64_t most_ = 0;
};

/// Pieces in a fixed tree inside their group, groups in a fixed tree above. Empty groups take no
/// part in the arithmetic but keep their place.
template <class Sum, class Merge>
class PieceTree {
  public:
    /// merge(Sum& left, const Sum& right) adds right to left. The layout outlives the tree.
    PieceTree(const PieceLayout& layout, Merge merge)
        : layout_(layout),
          total_(layout.group_count(), MergeOptional{merge}),
          group_of_(layout.pieces.size()),
          missing_(static_cast<size_t>(layout.group_count())) {
        for (int64_t g = 0; g < layout.group_count(); ++g) {
            const int64_t first = first_piece(g), end = first_piece(g + 1);
            for (int64_t p = first; p < end; ++p) group_of_[static_cast<size_t>(p)] = g;
            groups_.push_back(std::make_unique<Tree>(end - first, MergeOptional{merge}));
            missing_[static_cast<size_t>(g)] = end - first;
        }
    }

    /// Thread-safe.
    void insert_piece(int64_t piece, Sum sum) {
        const int64_t group = group_of_[static_cast<size_t>(piece)];
        insert(group, 0, piece - first_piece(group), std::move(sum));
    }

    void insert_empty_groups() {
        for (int64_t g = 0; g < layout_.group_count(); ++g) {
            if (first_piece(g) == first_piece(g + 1)) total_.insert_leaf(g, std::nullopt);
        }
    }

    /// The subtrees that wait for siblings held by other ranks, as a message to them.
    std::string pack_waiting() const {
        Packer out;
        pack_tree(out, whole, total_);
        for (int64_t g = 0; g < layout_.group_count(); ++g) {
            if (const auto& group = groups_[static_cast<size_t>(g)]) pack_tree(out, g, *group);
        }
        return out.take();
    }

    void insert_waiting(std::string message) {
        for (Unpacker in(std::move(message)); in.left() > 0;) {
            const auto group = in.get<int64_t>();
            const auto level = in.get<int32_t>();
            const auto index = in.get<int64_t>();
            std::optional<Sum> sum;
            unpack(in, sum);
            insert(group, level, index, std::move(sum));
        }
    }

    /// The sum of all pieces, once all are in; nothing when there is none.
    std::optional<Sum> take_root() {
        std::optional<std::optional<Sum>> root = total_.take_root();
        return root ? std::move(*root) : std::nullopt;
    }

  private:
    struct MergeOptional {
        Merge merge;
        void operator()(std::optional<Sum>& left, const std::optional<Sum>& right) const {
            if (!right) return;
            if (left) {
                merge(*left, *right);
            } else {
                left = *right;
            }
        }
    };
    using Tree = FixedTree<std::optional<Sum>, MergeOptional>;
    static constexpr int64_t whole = -1;  ///< stands for the tree above the groups in a message

    int64_t first_piece(int64_t group) const {
        return layout_.group_first[static_cast<size_t>(group)];
    }

    void insert(int64_t group, int level, int64_t index, std::optional<Sum> sum) {
        if (group == whole) return total_.insert(level, index, std::move(sum));
        const auto g = static_cast<size_t>(group);
        const int64_t brought = groups_[g]->leaves_below(level, index);
        groups_[g]->insert(level, index, std::move(sum));
        if ((missing_[g] -= brought) == 0) {
            total_.insert_leaf(group, *groups_[g]->take_root());
            groups_[g].reset();
        }
    }

    static void pack_tree(Packer& out, int64_t group, const Tree& tree) {
        for (const auto& [node, sum] : tree.waiting()) {
            out.put<int64_t>(group).template put<int32_t>(node.first);
            out.template put<int64_t>(node.second);
            pack(out, sum);
        }
    }

    const PieceLayout& layout_;
    Tree total_;
    std::vector<int64_t> group_of_;
    std::vector<std::unique_ptr<Tree>> groups_;  ///< none once its sum is in the total
    std::vector<std::atomic<int64_t>> missing_;  ///< pieces, of each group
};

/// Sum of leaf(piece) over all pieces of a layout, merged by merge(left, right), the same at every
/// rank; nothing when there is no piece. leaf() is called on several threads, for this rank's share
/// and for pieces of other shares whose ranks, on the same machine, are slower.
template <class Sum, class Leaf, class Merge>
std::optional<Sum> sum_pieces(const Workers& workers, const PieceLayout& layout, Leaf&& leaf,
                              Merge merge) {
    PieceTree<Sum, Merge> tree(layout, merge);
    const auto sum_piece = [&](int64_t piece) {
        tree.insert_piece(piece, leaf(layout.pieces[static_cast<size_t>(piece)]));
    };
    if (workers.is_root()) tree.insert_empty_groups();
    if (workers.rank_count() == 1) {
        parallel_for(workers.threads, static_cast<int64_t>(layout.pieces.size()), sum_piece);
        return tree.take_root();
    }
    SharedPieces pieces(layout, workers);
    parallel_for(workers.threads, pieces.most(), [&](int64_t) {
        if (const std::optional<int64_t> piece = pieces.take()) sum_piece(*piece);
    });

    // Neighbours join their subtrees, then neighbouring pairs theirs: what joins shrinks to the few
    // subtrees that wait at the edges of runs, so that no rank ever holds those of all.
    for (int apart = 1; apart < workers.rank_count(); apart *= 2) {
        const bool gives = workers.rank() % (2 * apart) == apart;
        const int to = gives ? workers.rank() - apart : Communicator::nobody;
        tree.insert_waiting(workers.ranks->pass(to, gives ? tree.pack_waiting() : ""));
    }
    Packer out;
    if (workers.is_root()) pack(out, tree.take_root());
    return unpacked<std::optional<Sum>>(workers.ranks->broadcast(out.take()));
}

}  // namespace kinetome
