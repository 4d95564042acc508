#include "kinetome/run/communicator.h"

#ifdef KINETOME_WITH_MPI
#include "mpi/mpi_communicator.h"
#endif

namespace kinetome {

bool can_join_ranks() {
#ifdef KINETOME_WITH_MPI
    return true;
#else
    return false;
#endif
}

std::unique_ptr<Communicator> start_ranks([[maybe_unused]] const Launch& launch,
                                          [[maybe_unused]] size_t largest_message) {
#ifdef KINETOME_WITH_MPI
    if (launch.offers_mpi && launch.processes != 1) {
        return std::make_unique<MpiCommunicator>(largest_message);
    }
#endif
    return std::make_unique<SerialCommunicator>();
}

}  // namespace kinetome
