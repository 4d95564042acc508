// Sets that are united from many threads at once.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

namespace kinetome {

/// Which elements are together at the end does not depend on the order in which they are united.
class DisjointSets {
  public:
    explicit DisjointSets(int64_t count) : parents_(static_cast<size_t>(count)) {
        for (int64_t i = 0; i < count; ++i)
            parent(static_cast<int32_t>(i)) = static_cast<int32_t>(i);
    }

    /// The lowest element of the set, as far as it has been united.
    int32_t root(int32_t element) {
        for (;;) {
            int32_t above = parent(element);
            const int32_t beyond = parent(above);
            if (above == beyond) return above;
            // Paths become shorter as they are walked; a thread that comes too late loses nothing.
            parent(element).compare_exchange_weak(above, beyond);
            element = beyond;
        }
    }

    bool together(int32_t a, int32_t b) { return root(a) == root(b); }

    void unite(int32_t a, int32_t b) {
        for (;;) {
            a = root(a);
            b = root(b);
            if (a == b) return;
            if (a < b) std::swap(a, b);
            int32_t expected = a;
            if (parent(a).compare_exchange_strong(expected, b)) return;
        }
    }

  private:
    std::atomic<int32_t>& parent(int32_t element) { return parents_[static_cast<size_t>(element)]; }

    std::vector<std::atomic<int32_t>> parents_;
};

}  // namespace kinetome
