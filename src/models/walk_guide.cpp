#include "walk_guide.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace kinetome {
namespace {

constexpr double unreachable = std::numeric_limits<double>::infinity();

std::vector<int32_t> all_nodes(const MotionGraph& graph) {
    std::vector<int32_t> nodes(static_cast<size_t>(graph.nodes()));
    std::iota(nodes.begin(), nodes.end(), 0);
    return nodes;
}

double frames(const MotionGraph& graph, int32_t piece) {
    return static_cast<double>(graph.piece(piece).frames());
}

}  // namespace

double frames_of_step(const MotionGraph& graph, int32_t entry, const Succession& exit) {
    return (frames(graph, entry) + frames(graph, exit.piece)) / 2 +
           static_cast<double>(graph.gap(exit));
}

WalkGuide::WalkGuide(const MotionGraph& graph, const WalkRequest& request) : graph_(graph) {
    const auto anywhere = all_nodes(graph);
    goals_ = request.to.empty() ? anywhere : graph.with_linked(request.to);
    const auto& sources = request.from.empty() ? anywhere : request.from;
    allowed_ = nodes_that_reach(graph, goals_);
    to_goal_ = frames_to(goals_);

    std::vector<int32_t> starts;
    for (const int32_t node : sources) {
        if (allowed(node) && !graph.members(node).empty()) starts.push_back(node);
    }
    const auto cycle = largest_cycle(starts);
    lasting_ = nodes_that_reach(graph, cycle);
    // Of the starts, those that lead to the cycle.
    const auto last = std::ranges::stable_partition(
        starts, [&](int32_t node) { return cycle.empty() || lasting(node); });
    starts.erase(last.begin(), last.end());
    if (request.from.empty() && !cycle.empty()) starts = cycle;
    starts_ = std::move(starts);
}

bool WalkGuide::is_goal(int32_t node) const {
    return std::ranges::binary_search(goals_, node);
}

std::vector<Succession> WalkGuide::ways_to_goal(int32_t node) const {
    std::vector<Succession> ways = graph_.ways_on(node);
    std::erase_if(ways, [&](const Succession& way) { return !allowed(graph_.node_of(way.next)); });
    return ways;
}

std::vector<Succession> WalkGuide::ways_on(int32_t node) const {
    const std::vector<Succession> open = ways_to_goal(node);
    std::vector<Succession> for_ever;
    std::ranges::copy_if(open, std::back_inserter(for_ever),
                         [&](const Succession& way) { return lasting(graph_.node_of(way.next)); });
    return for_ever.empty() ? open : for_ever;
}

std::vector<int32_t> WalkGuide::largest_cycle(const std::vector<int32_t>& starts) const {
    const auto reached = nodes_reached(graph_, starts);
    const StrongComponents components = strong_components(graph_);
    std::vector<int32_t> best;
    size_t best_pieces = 0;
    for (size_t i = 0; i < components.nodes.size(); ++i) {
        const auto& nodes = components.nodes[i];
        const bool usable = reached[static_cast<size_t>(nodes.front())];
        if (!components.cyclic[i] || !usable || !allowed(nodes.front())) continue;
        size_t pieces = 0;
        for (const int32_t node : nodes) pieces += graph_.members(node).size();
        if (pieces <= best_pieces) continue;
        best_pieces = pieces;
        best = nodes;
    }
    return best;
}

double WalkGuide::mean_frames(int32_t node) const {
    double sum = 0;
    for (const int32_t piece : graph_.members(node)) sum += frames(graph_, piece);
    const auto count = static_cast<double>(graph_.members(node).size());
    return count > 0 ? sum / count : 0;
}

std::vector<double> WalkGuide::frames_to(const std::vector<int32_t>& goals) const {
    std::vector<std::vector<int32_t>> sources(static_cast<size_t>(graph_.nodes()));
    for (int32_t node = 0; node < graph_.nodes(); ++node) {
        for (const int32_t target : graph_.next_nodes(node)) {
            sources[static_cast<size_t>(target)].push_back(node);
        }
    }
    std::vector<double> least(sources.size(), unreachable);
    using Entry = std::pair<double, int32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    const auto improve = [&](int32_t node, double left) {
        const double here = left + mean_frames(node);
        if (here >= least[static_cast<size_t>(node)]) return;
        least[static_cast<size_t>(node)] = here;
        queue.emplace(here, node);
    };
    for (const int32_t goal : goals) improve(goal, 0);
    while (!queue.empty()) {
        const auto [left, node] = queue.top();
        queue.pop();
        if (left > least[static_cast<size_t>(node)]) continue;
        for (const int32_t source : sources[static_cast<size_t>(node)]) improve(source, left);
    }
    return least;
}

}  // namespace kinetome
