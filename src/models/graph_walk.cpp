#include "kinetome/models/graph_walk.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <stdexcept>
#include <utility>

#include "kinetome/base/random.h"

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

/// What it takes from the seam where `entry` begins to the one where what follows `exit` does.
double frames_of_step(const MotionGraph& graph, int32_t entry, const Succession& exit) {
    return (frames(graph, entry) + frames(graph, exit.piece)) / 2 +
           static_cast<double>(graph.gap(exit));
}

/// Where a walk may go, and where it should.
class Guide {
  public:
    Guide(const MotionGraph& graph, const WalkRequest& request) : graph_(graph) {
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

    const std::vector<int32_t>& starts() const { return starts_; }
    /// Whether a walk may end in a node: linked ones are as good as those that are wanted.
    bool is_goal(int32_t node) const { return std::ranges::binary_search(goals_, node); }
    /// Frames from entering a node to the end of the nearest goal, by the mean length of pieces.
    double frames_to_goal(int32_t node) const { return to_goal_[static_cast<size_t>(node)]; }

    /// Successions to nodes from which the walk can go on: for ever, if there are such.
    std::vector<Succession> ways_on(int32_t node) const {
        std::vector<Succession> open, for_ever;
        for (const Succession& way : graph_.ways_on(node)) {
            const int32_t target = graph_.node_of(way.next);
            if (allowed(target)) open.push_back(way);
            if (allowed(target) && lasting(target)) for_ever.push_back(way);
        }
        return for_ever.empty() ? open : for_ever;
    }

    /// Successions on the shortest way to a goal.
    std::vector<Succession> ways_to_goal(int32_t node) const {
        std::vector<Succession> ways;
        double least = unreachable;
        for (const Succession& way : graph_.ways_on(node)) {
            const double left = frames_to_goal(graph_.node_of(way.next));
            if (left < least) ways.clear();
            least = std::min(least, left);
            if (left == least && left < unreachable) ways.push_back(way);
        }
        return ways;
    }

  private:
    bool allowed(int32_t node) const { return allowed_[static_cast<size_t>(node)]; }
    bool lasting(int32_t node) const { return lasting_[static_cast<size_t>(node)]; }

    /// The nodes of the cycle with most pieces within reach; empty when there is none.
    std::vector<int32_t> largest_cycle(const std::vector<int32_t>& starts) const {
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

    double mean_frames(int32_t node) const {
        double sum = 0;
        for (const int32_t piece : graph_.members(node)) sum += frames(graph_, piece);
        const auto count = static_cast<double>(graph_.members(node).size());
        return count > 0 ? sum / count : 0;
    }

    /// Dijkstra, against the edges.
    std::vector<double> frames_to(const std::vector<int32_t>& goals) const {
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

    const MotionGraph& graph_;
    std::vector<int32_t> goals_;  ///< ascending
    std::vector<bool> allowed_, lasting_;
    std::vector<double> to_goal_;
    std::vector<int32_t> starts_;
};

template <class T>
const T& any_of(const std::vector<T>& choices, RandomStream& random) {
    return choices[static_cast<size_t>(random.below(choices.size()))];
}

void check(const MotionGraph& graph, const std::vector<int32_t>& nodes) {
    const auto outside = [&](int32_t node) { return node < 0 || node >= graph.nodes(); };
    if (std::ranges::any_of(nodes, outside)) {
        throw std::invalid_argument("a walk names a node that is not in its graph");
    }
}

/// Goes on step by step, and back where all ways on have an excess.
class Walker {
  public:
    Walker(const MotionGraph& graph, const WalkRequest& request)
        : graph_(graph),
          request_(request),
          guide_(graph, request),
          random_(request.seed, "motion walk"),
          stuck_(graph.pieces().size(), false) {
        for (const int32_t node : guide_.starts()) {
            const auto members = graph.members(node);
            first_pieces_.insert(first_pieces_.end(), members.begin(), members.end());
        }
    }

    GraphWalk walk() {
        if (first_pieces_.empty()) return {};
        entry_ = any_of(first_pieces_, random_);
        while (true) {
            const bool fills = filled() >= request_.frames;
            const auto ways = ways_on(fills);
            if (ways.empty()) return ended();
            if (const auto way = fitting(ways)) {
                go(*way);
            } else if (fills || !may_go_back_ || !go_back()) {
                go(of_least_excess(ways));
            }
        }
    }

  private:
    int32_t node() const { return graph_.node_of(entry_); }
    bool has_goal() const { return !request_.to.empty(); }
    double excess(int32_t exit) const {
        return request_.excess ? request_.excess(entry_, exit) : 0;
    }

    double filled() const {
        return walk_.frames + (has_goal() ? guide_.frames_to_goal(node()) : frames(graph_, entry_));
    }
    std::vector<Succession> ways_on(bool fills) const {
        if (!fills) return guide_.ways_on(node());
        if (!has_goal() || guide_.is_goal(node())) return {};
        return guide_.ways_to_goal(node());
    }

    /// Any of the ways without excess, after which the walk is not known to get stuck.
    std::optional<Succession> fitting(std::vector<Succession> ways) {
        while (!ways.empty()) {
            const auto at = static_cast<std::ptrdiff_t>(random_.below(ways.size()));
            const Succession way = ways[static_cast<size_t>(at)];
            if (!stuck_[static_cast<size_t>(way.next)] && excess(way.piece) <= 0) return way;
            ways.erase(ways.begin() + at);
        }
        return std::nullopt;
    }
    Succession of_least_excess(const std::vector<Succession>& ways) const {
        return *std::ranges::min_element(ways, {},
                                         [&](const Succession& way) { return excess(way.piece); });
    }

    void go(const Succession& way) {
        frames_before_.push_back(walk_.frames);
        walk_.steps.push_back({node(), entry_, way.piece});
        walk_.frames += frames_of_step(graph_, entry_, way);
        entry_ = way.next;
    }
    /// To the piece before, from which another way is then taken; from the first one to another
    /// first one. False when there is none left.
    bool go_back() {
        stuck_[static_cast<size_t>(entry_)] = true;
        if (walk_.steps.empty()) {
            std::vector<int32_t> left;
            std::ranges::copy_if(first_pieces_, std::back_inserter(left), [&](int32_t piece) {
                return !stuck_[static_cast<size_t>(piece)];
            });
            if (left.empty()) {
                stuck_.assign(stuck_.size(), false);
                return may_go_back_ = false;
            }
            entry_ = any_of(left, random_);
            return true;
        }
        entry_ = walk_.steps.back().entry;
        walk_.frames = frames_before_.back();
        walk_.steps.pop_back();
        frames_before_.pop_back();
        return true;
    }

    /// The last node is left by none: in one that is only linked with what is wanted, the walk goes
    /// over into that.
    int32_t last_exit() const {
        const auto wanted = [&](int32_t node) { return std::ranges::count(request_.to, node) > 0; };
        if (!has_goal() || !guide_.is_goal(node()) || wanted(node())) return entry_;
        std::vector<int32_t> exits;
        for (const int32_t other : graph_.linked(node())) {
            if (!wanted(other)) continue;
            const auto members = graph_.members(other);
            exits.insert(exits.end(), members.begin(), members.end());
        }
        return *std::ranges::min_element(exits, {}, [&](int32_t exit) { return excess(exit); });
    }

    GraphWalk ended() {
        walk_.steps.push_back({node(), entry_, last_exit()});
        walk_.frames += frames(graph_, entry_);
        walk_.ended_early = walk_.frames < request_.frames;
        return std::move(walk_);
    }

    const MotionGraph& graph_;
    const WalkRequest& request_;
    Guide guide_;
    RandomStream random_;
    std::vector<int32_t> first_pieces_;
    std::vector<bool> stuck_;  ///< pieces: whoever enters by them can go on with excess only
    GraphWalk walk_;
    std::vector<double> frames_before_;  ///< each step
    int32_t entry_ = 0;                  ///< of the step at hand
    bool may_go_back_ = true;            ///< false when no walk is without excess
};

}  // namespace

GraphWalk random_walk(const MotionGraph& graph, const WalkRequest& request) {
    check(graph, request.from);
    check(graph, request.to);
    return Walker(graph, request).walk();
}

}  // namespace kinetome
