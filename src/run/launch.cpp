#include "kinetome/run/launch.h"

#include <fmt/format.h>

#include <charconv>

namespace kinetome {
namespace {

std::optional<int> number_in(const Environment& environment, const std::string& name) {
    const auto text = environment(name);
    if (!text) return std::nullopt;
    int number = 0;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), number);
    const bool whole = error == std::errc() && end == text->data() + text->size();
    return whole && number > 0 ? std::optional(number) : std::nullopt;
}

}  // namespace

Launch launch_of(const Environment& environment) {
    const bool by_pmix = environment("PMIX_RANK").has_value();
    // First the innermost: mpirun inside a job of Slurm passes Slurm's variables on.
    if (const auto processes = number_in(environment, "OMPI_COMM_WORLD_SIZE")) {
        return {*processes, true, "mpirun"};
    }
    if (const auto processes = number_in(environment, "SLURM_STEP_NUM_TASKS")) {
        return {*processes, by_pmix, "srun"};
    }
    if (by_pmix) return {0, true, "a PMIx launcher"};
    if (const auto processes = number_in(environment, "PMI_SIZE")) {
        return {*processes, false, "a PMI launcher"};
    }
    return {};
}

void require_joined(const Launch& launch, const Communicator& ranks) {
    if (launch.processes <= ranks.size()) return;
    const std::string found =
        fmt::format("{} started {} processes", launch.launcher, launch.processes);
#ifdef KINETOME_WITH_MPI
    throw UsageError(found +
                     " that cannot find each other, so that each would do the whole work: use "
                     "`srun --mpi=pmix` or Open MPI's mpirun, or start one process");
#else
    throw UsageError(found +
                     ", but this kinetome was built without MPI, so that each would do the whole "
                     "work: build it with -DKINETOME_WITH_MPI=ON, or start one process");
#endif
}

}  // namespace kinetome
