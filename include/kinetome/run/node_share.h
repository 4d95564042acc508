// Which ranks of a run share a node, and which of those its processors.
#pragma once

#include <string>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/resources.h"

namespace kinetome {

/// Where a process runs, as text to be compared.
struct Place {
    std::string node;
    std::string processors;  ///< that it may run on
};

Place place_of_this_process();

/// The share of `rank`, of ranks at these places.
NodeShare node_share(const std::vector<Place>& places, size_t rank);

/// The share of this rank. All ranks call it.
NodeShare node_share(Communicator& ranks);

}  // namespace kinetome
