// How this process was started: alone, or by a launcher of parallel jobs among others.
#pragma once

#include <string>

#include "kinetome/base/communicator.h"
#include "kinetome/base/environment.h"

namespace kinetome {

struct Launch {
    int processes = 1;        ///< started together; 0 when the launcher does not tell
    bool offers_mpi = false;  ///< they can find each other through Open MPI
    std::string launcher;     ///< "mpirun", "srun", …; empty when there is none
};

/// As the launchers tell it in the environment: Open MPI's mpirun, Slurm's srun, others by PMI.
Launch launch_of(const Environment& environment);

/// Throws UsageError when this process is one of several that are not ranks of one run: each would
/// do the whole work, and all would contend for the store. For commands that write.
void require_joined(const Launch& launch, const Communicator& ranks);

}  // namespace kinetome
