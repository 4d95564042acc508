// A list of items that its owner works off from the front while others, who have nothing left to
// do, take items from its back.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

namespace kinetome {

/// What is left of the items 0 … n - 1; may lie in memory that processes share. Each item is taken
/// once.
class WorkList {
  public:
    /// Puts n items up, n < 2^32. Only while nobody takes from what was there before.
    void refill(int64_t items) {
        left_.store(static_cast<uint64_t>(items), std::memory_order_release);
    }
    int64_t left() const {
        const uint64_t range = left_.load(std::memory_order_acquire);
        return static_cast<int64_t>(end_of(range)) - static_cast<int64_t>(first_of(range));
    }
    std::optional<int64_t> take_front() {
        return take([](uint64_t range) { return first_of(range); }, uint64_t{1} << 32);
    }
    std::optional<int64_t> take_back() {
        return take([](uint64_t range) { return end_of(range) - 1; }, ~uint64_t{0});
    }

  private:
    // First item in the upper half, end in the lower one: both change at once.
    static uint64_t first_of(uint64_t range) { return range >> 32; }
    static uint64_t end_of(uint64_t range) { return range & 0xFFFFFFFF; }

    template <class Item>
    std::optional<int64_t> take(Item item, uint64_t step) {
        uint64_t range = left_.load(std::memory_order_acquire);
        do {
            if (first_of(range) >= end_of(range)) return std::nullopt;
        } while (!left_.compare_exchange_weak(range, range + step, std::memory_order_acq_rel));
        return static_cast<int64_t>(item(range));
    }

    static_assert(std::atomic<uint64_t>::is_always_lock_free, "else processes cannot share it");
    std::atomic<uint64_t> left_{0};
};

}  // namespace kinetome
