// A request to stop, raised by a signal and looked at between blocks of work.
#pragma once

#include <atomic>

#include "kinetome/base/error.h"

namespace kinetome {

/// Cheap to copy; refers to a flag that outlives it. Default-constructed: never stops.
class StopToken {
  public:
    StopToken() = default;
    explicit StopToken(const std::atomic<bool>& requested) : requested_(&requested) {}

    bool requested() const { return requested_ && requested_->load(std::memory_order_relaxed); }

    /// Throws Interrupted when a stop was asked for. Call where finished work is safe on disk.
    void check() const {
        if (requested()) throw Interrupted();
    }

  private:
    const std::atomic<bool>* requested_ = nullptr;
};

}  // namespace kinetome
