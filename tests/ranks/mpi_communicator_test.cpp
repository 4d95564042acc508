// The communicator of MPI under mpirun: the same cases as for ranks that are threads.
#include <catch2/catch.hpp>

#include "mpirun.h"
#include "support/communicator_cases.h"

namespace cases = communicator_cases;
using kinetome::ExitCode;

namespace {

constexpr size_t whole_messages = size_t{1} << 30;
/// No message of the cases is that short: all go in parts.
constexpr size_t tiny_parts = 7;

CommandResult run_case(const std::string& name, int ranks, size_t largest_message) {
    return run(as_ranks(ranks, {KINETOME_RANK_PROGRAM, std::to_string(largest_message), name}));
}

}  // namespace

TEST_CASE("ranks of MPI keep the promises of ranks, with messages whole or in parts", "[mpi]") {
    for (const int ranks : {1, 2, 3, 4}) {
        for (const size_t largest_message : {whole_messages, tiny_parts}) {
            INFO(ranks << " ranks, messages up to " << largest_message << " bytes");
            const CommandResult ended = run_case("all peaceful cases", ranks, largest_message);
            INFO(ended.errors);
            CHECK(ended.output == std::to_string(ranks) + " ranks ended well\n");
            CHECK(ended.exit_code == 0);
        }
    }
}

TEST_CASE("a rank of MPI that fails ends all with its code and message", "[mpi]") {
    for (const int ranks : {2, 4}) {
        const std::string news = "rank " + std::to_string(ranks - 1) + ": disk full\n";
        for (const auto& [name, body] : cases::failing) {
            INFO(name << ", " << ranks << " ranks");
            const CommandResult ended = run_case(name, ranks, tiny_parts);
            INFO(ended.errors);
            CHECK(ended.output == news);
            CHECK(ended.exit_code == static_cast<int>(cases::code_of_failure));
        }
    }
}

TEST_CASE("all ranks of MPI may fail at once", "[mpi]") {
    const CommandResult ended = run_case("every rank fails", 3, whole_messages);
    INFO(ended.errors);
    CHECK(ended.output == "disk full at 0\n");
    CHECK(ended.exit_code == static_cast<int>(cases::code_of_failure));
}

TEST_CASE("ranks of MPI that make different calls are stopped, not left waiting", "[mpi]") {
    const CommandResult ended = run_case("ranks make different calls", 3, whole_messages);
    CHECK(ended.output == "ranks make different calls\n");
    CHECK(ended.exit_code == static_cast<int>(ExitCode::internal));
}

TEST_CASE("an exception that escapes a rank of MPI ends the others", "[mpi]") {
    const CommandResult ended = run_case("an exception escapes", 3, whole_messages);
    CHECK(ended.exit_code == static_cast<int>(ExitCode::internal));
    CHECK_THAT(ended.errors, Catch::Contains("kinetome: rank 2: ended by an exception"));
}

TEST_CASE("a rank of MPI that is killed does not leave the others waiting", "[mpi]") {
    const CommandResult ended = run_case("the last rank is killed", 3, whole_messages);
    CHECK(ended.exit_code == 128 + SIGKILL);
}
