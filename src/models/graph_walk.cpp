#include "kinetome/models/graph_walk.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>

#include "kinetome/base/random.h"
#include "way_to_goal.h"

namespace kinetome {
namespace {

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
            const auto ways = fills ? std::vector<Succession>{} : guide_.ways_on(node());
            if (ways.empty()) {
                if (end()) return std::move(walk_);
            } else if (const auto way = fitting(ways)) {
                go(*way);
            } else if (!may_go_back_ || !go_back()) {
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
        return walk_.frames + (has_goal() ? guide_.frames_to_goal(node()) : frames_of_entry());
    }
    double frames_of_entry() const { return static_cast<double>(graph_.piece(entry_).frames()); }

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

    WayToGoal way_to_goal() {
        if (!has_goal()) return {.successions = {}, .last_exit = entry_};
        if (may_go_back_) {
            if (auto way = find_way_to_goal(graph_, guide_, request_, entry_, &stuck_)) return *way;
        }
        return *find_way_to_goal(graph_, guide_, request_, entry_, nullptr);
    }

    /// False after going back, and after a step on the way to a goal that is shorter than it
    /// seemed.
    bool end() {
        const WayToGoal way = way_to_goal();
        if (way.excess > 0 && may_go_back_ && go_back()) return false;
        for (const Succession& step : way.successions) {
            go(step);
            if (filled() < request_.frames) return false;
        }
        walk_.steps.push_back({node(), entry_, way.last_exit});
        walk_.frames += frames_of_entry();
        walk_.ended_early = walk_.frames < request_.frames;
        return true;
    }

    const MotionGraph& graph_;
    const WalkRequest& request_;
    WalkGuide guide_;
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
