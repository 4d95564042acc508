#include "kinetome/run/launch.h"

#include <catch2/catch.hpp>

#include <map>

using namespace kinetome;

namespace {

Launch launch_with(const std::map<std::string, std::string>& variables) {
    return launch_of([&](const std::string& name) -> std::optional<std::string> {
        const auto found = variables.find(name);
        return found == variables.end() ? std::nullopt : std::optional(found->second);
    });
}

}  // namespace

TEST_CASE("without a launcher a process is alone", "[launch]") {
    for (const auto& variables : std::vector<std::map<std::string, std::string>>{
             {},
             {{"SLURM_JOB_ID", "7"}, {"SLURM_NTASKS", "16"}},  // the script of a batch job
             {{"OMPI_COMM_WORLD_SIZE", "many"}, {"SLURM_STEP_NUM_TASKS", ""}, {"PMI_SIZE", "-3"}},
         }) {
        const Launch launch = launch_with(variables);
        CHECK(launch.processes == 1);
        CHECK_FALSE(launch.offers_mpi);
    }
}

TEST_CASE("launchers that Open MPI can join are told from those it cannot", "[launch]") {
    const Launch by_mpirun =
        launch_with({{"OMPI_COMM_WORLD_SIZE", "4"}, {"PMIX_RANK", "3"}, {"SLURM_PROCID", "0"}});
    CHECK(by_mpirun.processes == 4);
    CHECK(by_mpirun.offers_mpi);
    CHECK(by_mpirun.launcher == "mpirun");

    const Launch by_srun_with_pmix =
        launch_with({{"SLURM_STEP_NUM_TASKS", "8"}, {"PMIX_RANK", "0"}});
    CHECK(by_srun_with_pmix.processes == 8);
    CHECK(by_srun_with_pmix.offers_mpi);

    const Launch by_srun = launch_with({{"SLURM_STEP_NUM_TASKS", "8"}});
    CHECK(by_srun.processes == 8);
    CHECK_FALSE(by_srun.offers_mpi);
    CHECK(by_srun.launcher == "srun");

    CHECK(launch_with({{"PMIX_RANK", "0"}}).offers_mpi);
    CHECK(launch_with({{"PMI_SIZE", "2"}}).processes == 2);
    CHECK_FALSE(launch_with({{"PMI_SIZE", "2"}}).offers_mpi);
}

TEST_CASE("mpirun inside a job of Slurm is the launcher that counts", "[launch]") {
    // Of Slurm's own step, which starts mpirun's daemons, there is one process a node.
    const Launch launch = launch_with(
        {{"OMPI_COMM_WORLD_SIZE", "16"}, {"PMIX_RANK", "5"}, {"SLURM_STEP_NUM_TASKS", "2"}});
    CHECK(launch.processes == 16);
    CHECK(launch.launcher == "mpirun");
}

TEST_CASE("processes that do not know each other may not all write a store", "[launch]") {
    const SerialCommunicator alone;
    CHECK_THROWS_AS(require_joined({8, false, "srun"}, alone), UsageError);
    CHECK_THROWS_WITH(require_joined({8, false, "srun"}, alone),
                      Catch::StartsWith("srun started 8 processes"));
    // MPI was to join them, and each found itself alone.
    CHECK_THROWS_AS(require_joined({8, true, "mpirun"}, alone), UsageError);
    CHECK_NOTHROW(require_joined({1, false, "srun"}, alone));
    CHECK_NOTHROW(require_joined({}, alone));
    CHECK_NOTHROW(require_joined({0, true, "a PMIx launcher"}, alone));
}
