// Dense parallel loops (OpenMP) and sums in a fixed tree: the result never depends on the number
// of threads or on who finishes first, and an exception leaves the loop as on one thread.
// Irregular work (files, clips) goes to oneTBB instead, never one inside the other.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "kinetome/base/pieces.h"

namespace kinetome {

/// Runs worker() on `threads` threads at once, this one among them; it must not throw.
template <class Worker>
void run_team(int threads, const Worker& worker) {
#ifdef __SANITIZE_THREAD__
    // The thread sanitizer cannot see libgomp's barriers and would report every loop.
    std::vector<std::jthread> team;
    for (int t = 1; t < threads; ++t) team.emplace_back([&worker] { worker(); });
    worker();
#else
#pragma omp parallel num_threads(threads)
    worker();
#endif
}

/// Calls body(i) for i in [0, count), items handed out in order to `threads` threads. After a throw
/// no further item starts; the exception of the lowest index is rethrown. All items before that one
/// have run, so it is the exception a single thread would have met.
template <class Body>
void parallel_for(int threads, int64_t count, Body&& body) {
    if (threads <= 1 || count <= 1) {
        for (int64_t i = 0; i < count; ++i) body(i);
        return;
    }
    std::atomic<int64_t> next{0};
    std::atomic<bool> failed{false};
    std::mutex mutex;
    std::exception_ptr error;
    int64_t error_index = count;
    run_team(static_cast<int>(std::min<int64_t>(threads, count)), [&] {
        while (!failed.load(std::memory_order_relaxed)) {
            const int64_t i = next.fetch_add(1, std::memory_order_relaxed);
            if (i >= count) break;
            try {
                body(i);
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (i < error_index) {
                    error_index = i;
                    error = std::current_exception();
                }
                failed = true;
            }
        }
    });
    if (error) std::rethrow_exception(error);
}

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
    /// all leaves were here), as ((level, index), sum), for insert() there.
    std::map<std::pair<int, int64_t>, Sum> take_waiting() { return std::exchange(waiting_, {}); }

  private:
    int64_t nodes_at(int level) const { return (leaf_count_ + (int64_t{1} << level) - 1) >> level; }

    int64_t leaf_count_;
    Merge merge_;
    std::mutex mutex_;
    std::map<std::pair<int, int64_t>, Sum> waiting_;
};

/// Sum of leaf(piece) over all pieces of a layout, merged by merge(left, right): pieces in a fixed
/// tree inside their group, groups in a fixed tree above. Nothing when there is no piece.
/// Empty groups take no part in the arithmetic but keep their place in the tree.
template <class Sum, class Leaf, class Merge>
std::optional<Sum> sum_pieces(int threads, const PieceLayout& layout, Leaf&& leaf, Merge merge) {
    auto merge_optional = [&merge](std::optional<Sum>& left, const std::optional<Sum>& right) {
        if (!right) return;
        if (left) {
            merge(*left, *right);
        } else {
            left = *right;
        }
    };
    using Group = FixedTree<std::optional<Sum>, decltype(merge_optional)>;
    Group total(layout.group_count(), merge_optional);

    std::vector<int64_t> group_of(layout.pieces.size());
    std::vector<std::unique_ptr<Group>> groups(static_cast<size_t>(layout.group_count()));
    std::vector<std::atomic<int64_t>> missing(groups.size());
    for (size_t g = 0; g < groups.size(); ++g) {
        const int64_t first = layout.group_first[g], end = layout.group_first[g + 1];
        for (int64_t p = first; p < end; ++p) group_of[static_cast<size_t>(p)] = int64_t(g);
        groups[g] = std::make_unique<Group>(end - first, merge_optional);
        missing[g] = end - first;
        if (first == end) total.insert_leaf(int64_t(g), std::nullopt);
    }
    parallel_for(threads, static_cast<int64_t>(layout.pieces.size()), [&](int64_t p) {
        const auto g = static_cast<size_t>(group_of[static_cast<size_t>(p)]);
        groups[g]->insert_leaf(p - layout.group_first[g],
                               leaf(layout.pieces[static_cast<size_t>(p)]));
        if (--missing[g] == 0) {
            total.insert_leaf(int64_t(g), *groups[g]->take_root());
            groups[g].reset();
        }
    });
    std::optional<std::optional<Sum>> root = total.take_root();
    return root ? std::move(*root) : std::nullopt;
}

}  // namespace kinetome
