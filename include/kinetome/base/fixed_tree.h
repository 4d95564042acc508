// Sums in a fixed binary tree: the result never depends on how many threads or ranks brought the
// values, nor on who finished first (design §5).
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace kinetome {

/// A binary tree over `leaf_count` leaves whose shape depends on that number alone: node
/// (level, index) covers leaves [index << level, (index + 1) << level). Values may arrive in any
/// order and from any thread, as leaves or as whole subtrees (from another rank); siblings are
/// merged, left before right, by whoever brings the second. A node without a sibling at the right
/// edge is passed up unchanged.
template <class Sum, class Merge>
class FixedTree {
  public:
    /// merge(Sum& left, const Sum& right) adds right to left.
    FixedTree(int64_t leaf_count, Merge merge)
        : leaf_count_(leaf_count), merge_(std::move(merge)) {}

    void insert(int level, int64_t index, Sum value) {
        for (;;) {
            const int64_t sibling = index ^ 1;
            const bool is_root = nodes_at(level) == 1;
            if (is_root || sibling < nodes_at(level)) {
                std::unique_lock lock(mutex_);
                const auto waiting = waiting_.find({level, sibling});
                if (is_root || waiting == waiting_.end()) {
                    waiting_.emplace(std::pair(level, index), std::move(value));
                    return;
                }
                Sum other = std::move(waiting->second);
                waiting_.erase(waiting);
                lock.unlock();
                if (sibling < index) std::swap(value, other);
                merge_(value, other);
            }
            ++level;
            index >>= 1;
        }
    }
    void insert_leaf(int64_t index, Sum value) { insert(0, index, std::move(value)); }

    /// The sum of all leaves, once all are in; nothing before that or when there is no leaf.
    std::optional<Sum> take_root() {
        int level = 0;
        while (nodes_at(level) > 1) ++level;
        auto root = waiting_.extract({level, 0});
        return root ? std::optional<Sum>(std::move(root.mapped())) : std::nullopt;
    }

    /// What a rank sends: the subtrees that wait for a sibling held elsewhere (or the root, when
    /// all leaves were here), by (level, index), for insert() there.
    const std::map<std::pair<int, int64_t>, Sum>& waiting() const { return waiting_; }

    /// Leaves below a node.
    int64_t leaves_below(int level, int64_t index) const {
        return std::min((index + 1) << level, leaf_count_) - (index << level);
    }

  private:
    int64_t nodes_at(int level) const { return (leaf_count_ + (int64_t{1} << level) - 1) >> level; }

    int64_t leaf_count_;
    Merge merge_;
    std::mutex mutex_;
    std::map<std::pair<int, int64_t>, Sum> waiting_;
};

}  // namespace kinetome
