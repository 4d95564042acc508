// What a stretch of work costs: wall and processor seconds, highest resident size.
#pragma once

#include <chrono>

#include "kinetome/run/ledger.h"

namespace kinetome {

/// Starts when made. The kernel's peak counter is reset then, where it allows that; else the peak
/// is the process's so far.
class Meter {
  public:
    Meter();
    Cost cost() const;

  private:
    std::chrono::steady_clock::time_point started_;
    double cpu_started_;
};

}  // namespace kinetome
