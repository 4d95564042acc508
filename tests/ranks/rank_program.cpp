// rank_program LARGEST_MESSAGE CASE: what mpirun starts for the tests of MPI. Rank 0 tells how the
// case ended on standard output; every rank answers with the exit code.
#include <fmt/format.h>

#include <csignal>

#include "kinetome/run/communicator.h"
#include "kinetome/run/node_share.h"
#include "support/communicator_cases.h"

using namespace kinetome;
namespace cases = communicator_cases;

namespace {

void all_peaceful_cases(Communicator& ranks) {
    for (const auto& [name, body] : cases::peaceful) body(ranks);
    cases::expect(node_share(ranks).ranks == ranks.size(), "all ranks are on this machine");
}

/// The last rank dies and cannot say so.
void last_rank_is_killed(Communicator& ranks) {
    ranks.wait_for_all();
    if (ranks.rank() == ranks.size() - 1) std::raise(SIGKILL);
    ranks.wait_for_all();
}

cases::Case case_named(const std::string& name) {
    if (name == "all peaceful cases") return all_peaceful_cases;
    if (name == "every rank fails") return cases::every_rank_fails;
    if (name == "ranks make different calls") return cases::ranks_make_different_calls;
    if (name == "the last rank is killed") return last_rank_is_killed;
    return cases::failing.at(name);
}

void tell(const Communicator& ranks, const std::string& end) {
    if (!ranks.is_root()) return;
    fmt::print("{}\n", end);
    std::fflush(stdout);
}

int run_case(const cases::Case& body, Communicator& ranks) {
    const auto fail = [&ranks](ExitCode code, const std::string& message) {
        tell(ranks, message);
        return static_cast<int>(ranks.fail(code, message));
    };
    try {
        body(ranks);
        ranks.wait_for_all();
        tell(ranks, fmt::format("{} ranks ended well", ranks.size()));
        return 0;
    } catch (const RankFailure& failure) {
        tell(ranks, failure.what());
        return static_cast<int>(failure.exit_code());
    } catch (const Error& error) {
        return fail(error.exit_code(), error.what());
    } catch (const std::exception& error) {
        return fail(ExitCode::internal, error.what());
    }
}

/// An exception that was not told to the other ranks.
void leave_by_exception(Communicator& ranks) {
    ranks.wait_for_all();
    if (ranks.rank() == ranks.size() - 1) throw std::runtime_error("unforeseen");
    ranks.wait_for_all();
}

}  // namespace

int main(int, char** arguments) {
    const size_t largest_message = std::stoull(arguments[1]);
    const std::string name = arguments[2];
    // MPI even for one rank, which start_ranks would not need.
    const Launch launch{.processes = 0, .offers_mpi = true, .launcher = "mpirun"};
    try {
        const auto ranks = start_ranks(launch, largest_message);
        if (name != "an exception escapes") return run_case(case_named(name), *ranks);
        leave_by_exception(*ranks);
    } catch (const std::exception&) {
    }
    return 1;
}
