#include "kinetome/run/node_share.h"

#include <unistd.h>

#include <climits>
#include <fstream>

#include "kinetome/base/environment.h"
#include "kinetome/base/packing.h"

namespace kinetome {
namespace {

/// The list of processors as the kernel writes it, such as "0-3,8".
std::string allowed_processors() {
    const std::string mark = "Cpus_allowed_list:";
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with(mark)) return line.substr(mark.size());
    }
    return {};
}

}  // namespace

Place place_of_this_process() {
    char name[HOST_NAME_MAX + 1] = {};
    ::gethostname(name, sizeof name - 1);
    // Slurm may run several of its nodes on one machine, each with a share of its own.
    const auto slurm_node = environment_of_this_process()("SLURMD_NODENAME");
    return {slurm_node ? std::string(name) + " " + *slurm_node : name, allowed_processors()};
}

NodeShare node_share(const std::vector<Place>& places, size_t rank) {
    const Place& mine = places.at(rank);
    NodeShare share{0, 0};
    for (const Place& place : places) {
        if (place.node != mine.node) continue;
        ++share.ranks;
        if (place.processors == mine.processors) ++share.same_processors;
    }
    return share;
}

NodeShare node_share(Communicator& ranks) {
    const Place mine = place_of_this_process();
    std::vector<Place> places;
    for (std::string& bytes :
         ranks.gather_to_all(Packer().put(mine.node).put(mine.processors).take())) {
        Unpacker in(std::move(bytes));
        Place& place = places.emplace_back();
        place.node = in.get_text();
        place.processors = in.get_text();
    }
    return node_share(places, static_cast<size_t>(ranks.rank()));
}

}  // namespace kinetome
