// How far a long loop has come: a moving bar on a terminal, a timed line every ten seconds
// elsewhere, with count, rate and time left.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

#include "kinetome/base/log.h"

namespace kinetome {

/// Thread-safe. Ends with one line of count, seconds and rate when destroyed normally.
class Progress {
  public:
    Progress(const Log& log, std::string title, int64_t total, std::string unit);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void advance(int64_t count = 1);

  private:
    using Clock = std::chrono::steady_clock;
    void show(int64_t done, Clock::time_point now);

    Log log_;
    std::string title_;
    std::string unit_;
    int64_t total_;
    std::atomic<int64_t> done_{0};
    Clock::time_point started_;
    std::mutex mutex_;
    Clock::time_point shown_;
    bool bar_visible_ = false;
};

}  // namespace kinetome
