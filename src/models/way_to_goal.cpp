#include "way_to_goal.h"

#include <algorithm>
#include <queue>
#include <tuple>

namespace kinetome {
namespace {

/// A piece that is entered, and how.
struct Stop {
    int32_t entry = 0;
    double excess = 0, frames = 0;  ///< of the way to here
    int64_t before = -1;            ///< the stop that it was come from
    Succession way = {};            ///< from there
};

/// A way on from a stop, or the end there.
struct Step {
    double excess = 0;          ///< of the way with it; without it until `is_measured`
    double frames = 0;          ///< of the way with it, and from there to the goal
    int64_t stop = 0;           ///< that it goes on from
    int32_t exit = 0;           ///< piece that the stop's is exchanged for
    int32_t next = end_of_way;  ///< piece that follows
    bool is_measured = false;

    static constexpr int32_t end_of_way = -1;
    bool operator>(const Step& other) const { return order() > other.order(); }

  private:
    std::tuple<double, double, int64_t, int32_t> order() const {
        return {excess, frames, stop, exit};
    }
};

class Search {
  public:
    Search(const MotionGraph& graph, const WalkGuide& guide, const WalkRequest& request)
        : graph_(graph), guide_(guide), request_(request), reached_(graph.pieces().size(), false) {}

    std::optional<WayToGoal> run(int32_t entry, std::vector<bool>* stuck) {
        stop_at({.entry = entry});
        while (!steps_.empty()) {
            Step step = steps_.top();
            steps_.pop();
            if (step.next != Step::end_of_way && is_closed(step.next, stuck)) continue;
            if (!step.is_measured) step = measured(step);
            if (step.excess > 0 && stuck) continue;
            if (!steps_.empty() && step > steps_.top()) {
                steps_.push(step);
            } else if (step.next == Step::end_of_way) {
                return way_of(step);
            } else {
                stop_at(stop_of(step));
            }
        }
        if (stuck) {
            for (const Stop& stop : stops_) (*stuck)[static_cast<size_t>(stop.entry)] = true;
        }
        return std::nullopt;
    }

  private:
    bool is_wanted(int32_t node) const {
        return request_.to.empty() || std::ranges::count(request_.to, node) > 0;
    }
    bool is_closed(int32_t piece, const std::vector<bool>* stuck) const {
        const auto at = static_cast<size_t>(piece);
        return reached_[at] || (stuck && (*stuck)[at]);
    }

    Step measured(Step step) const {
        const int32_t entry = stops_[static_cast<size_t>(step.stop)].entry;
        if (request_.excess) step.excess += std::max(request_.excess(entry, step.exit), 0.0);
        step.is_measured = true;
        return step;
    }

    Stop stop_of(const Step& step) const {
        const Succession way{step.exit, step.next};
        const Stop& from = stops_[static_cast<size_t>(step.stop)];
        return {.entry = step.next,
                .excess = step.excess,
                .frames = from.frames + frames_of_step(graph_, from.entry, way),
                .before = step.stop,
                .way = way};
    }

    void stop_at(const Stop& stop) {
        const auto number = static_cast<int64_t>(stops_.size());
        stops_.push_back(stop);
        reached_[static_cast<size_t>(stop.entry)] = true;
        const int32_t node = graph_.node_of(stop.entry);
        for (const Succession& way : guide_.ways_to_goal(node)) {
            const double left = guide_.frames_to_goal(graph_.node_of(way.next));
            steps_.push({.excess = stop.excess,
                         .frames = stop.frames + frames_of_step(graph_, stop.entry, way) + left,
                         .stop = number,
                         .exit = way.piece,
                         .next = way.next});
        }
        if (!guide_.is_goal(node)) return;
        const auto end_with = [&](int32_t exit) {
            steps_.push({.excess = stop.excess,
                         .frames = stop.frames + guide_.frames_to_goal(node),
                         .stop = number,
                         .exit = exit});
        };
        if (is_wanted(node)) return end_with(stop.entry);
        for (const int32_t other : graph_.linked(node)) {
            if (is_wanted(other)) std::ranges::for_each(graph_.members(other), end_with);
        }
    }

    WayToGoal way_of(const Step& end) const {
        WayToGoal way{.successions = {}, .last_exit = end.exit, .excess = end.excess};
        for (int64_t at = end.stop; stops_[static_cast<size_t>(at)].before >= 0;) {
            const Stop& stop = stops_[static_cast<size_t>(at)];
            way.successions.push_back(stop.way);
            at = stop.before;
        }
        std::ranges::reverse(way.successions);
        return way;
    }

    const MotionGraph& graph_;
    const WalkGuide& guide_;
    const WalkRequest& request_;
    std::vector<Stop> stops_;
    std::vector<bool> reached_;  ///< pieces
    std::priority_queue<Step, std::vector<Step>, std::greater<>> steps_;
};

}  // namespace

std::optional<WayToGoal> find_way_to_goal(const MotionGraph& graph, const WalkGuide& guide,
                                          const WalkRequest& request, int32_t entry,
                                          std::vector<bool>* stuck) {
    return Search(graph, guide, request).run(entry, stuck);
}

}  // namespace kinetome
