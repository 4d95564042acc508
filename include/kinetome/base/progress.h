// How far a long loop has come: a moving bar on a terminal, a timed line every ten seconds
// elsewhere, with count, rate and time left.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

#include "kinetome/base/log.h"

namespace kinetome {

/// "1200 of 5000 frames (24.0 %), 350.1 frames/s, 11 s left"; an unknown total is 0.
std::string describe_progress(int64_t done, int64_t total, std::string_view unit, double seconds);

/// Thread-safe. Ends with one line of count, seconds and rate when destroyed normally, with none
/// when an exception ended the loop.
class Progress {
  public:
    using Clock = std::chrono::steady_clock;

    /// Off a terminal a line is logged at most every `line_interval`.
    Progress(const Log& log, std::string title, int64_t total, std::string unit,
             Clock::duration line_interval = std::chrono::seconds(10));
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void advance(int64_t count = 1);

  private:
    void show(int64_t done, Clock::time_point now);
    double seconds_until(Clock::time_point now) const;

    Log log_;
    std::string title_;
    std::string unit_;
    int64_t total_;
    bool bar_;
    Clock::duration interval_;
    int exceptions_;  ///< in flight when this was made
    std::atomic<int64_t> done_{0};
    Clock::time_point started_;
    std::mutex mutex_;
    Clock::time_point shown_;
    bool bar_visible_ = false;
};

}  // namespace kinetome
