// The nearest rows of one query so far.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace kinetome {

/// The nearer one is the lesser; of equally near ones the one of lower row.
struct Neighbour {
    double squared = 0;
    int32_t row = 0;
    auto operator<=>(const Neighbour&) const = default;
};

/// Collects more than it is to keep and drops the farthest now and then: cheaper than a heap.
class NearestRows {
  public:
    void reset(int64_t most, double squared_radius) {
        most_ = static_cast<size_t>(most);
        limit_ = {squared_radius, std::numeric_limits<int32_t>::max()};
        found_.clear();
    }
    /// Nothing beyond it is kept.
    const Neighbour& limit() const { return limit_; }

    /// Whether limit() came nearer.
    bool offer(const Neighbour& neighbour) {
        if (neighbour > limit_) return false;
        found_.push_back(neighbour);
        if (found_.size() < most_ + std::max<size_t>(most_ / 2, 8)) return false;
        drop_farthest();
        return true;
    }

    std::span<const Neighbour> sorted() {
        if (found_.size() > most_) drop_farthest();
        std::sort(found_.begin(), found_.end());
        return found_;
    }

  private:
    void drop_farthest() {
        const auto last = found_.begin() + static_cast<int64_t>(most_) - 1;
        std::nth_element(found_.begin(), last, found_.end());
        limit_ = *last;
        found_.resize(most_);
    }

    size_t most_ = 0;
    Neighbour limit_;
    std::vector<Neighbour> found_;
};

}  // namespace kinetome
