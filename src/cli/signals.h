// Signals that ask the program to stop.
#pragma once

#include "kinetome/base/stop.h"

namespace kinetome::cli {

/// From now on SIGTERM, SIGINT and SIGUSR1 request a stop: the first of each asks, a second one
/// ends. (mpirun passes SIGUSR1 on to its ranks, and kills them soon after a SIGTERM.)
/// Writing to a closed pipe or beyond a file-size limit becomes an error like any other.
StopToken watch_signals();

/// From now on those signals end the process again.
void stop_watching_signals();

}  // namespace kinetome::cli
