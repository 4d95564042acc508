// The ranks of a run: processes that a launcher started and MPI joins, or this one alone.
#pragma once

#include <cstddef>
#include <memory>

#include "kinetome/base/communicator.h"
#include "kinetome/run/launch.h"

namespace kinetome {

/// Whether this is a build with MPI.
bool can_join_ranks();

/// Joins the processes that were launched with this one, in a build with MPI and when the launcher
/// offers it; else this process is alone, and MPI is never started. Messages longer than
/// `largest_message` bytes go in parts; MPI counts bytes in an int.
/// The last one destroyed ends MPI: all ranks must have made the same calls by then. Destroyed
/// while an exception is in flight it ends the whole job, so that no rank waits for ever.
std::unique_ptr<Communicator> start_ranks(const Launch& launch,
                                          size_t largest_message = size_t{1} << 30);

}  // namespace kinetome
