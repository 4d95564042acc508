#include "kinetome/run/meter.h"

#include <fstream>

#include "kinetome/base/resources.h"

namespace kinetome {

Meter::Meter() : started_(std::chrono::steady_clock::now()), cpu_started_(cpu_seconds()) {
    std::ofstream("/proc/self/clear_refs") << "5";  // proc(5): reset the peak resident size
}

Cost Meter::cost() const {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started_;
    return {elapsed.count(), cpu_seconds() - cpu_started_, peak_resident_bytes()};
}

}  // namespace kinetome
