#include <algorithm>
#include <cmath>

#include "kinetome/math/warp.h"
#include "kinetome/models/graph_walk.h"

namespace kinetome {
namespace {

MotionRun run_of(const MotionPiece& piece) {
    return {.clip = piece.clip,
            .first = static_cast<double>(piece.first),
            .end = static_cast<double>(piece.end)};
}

bool is_inside(double middle, double fade, double length) {
    return middle >= fade / 2 && middle <= length - fade / 2;
}

/// The value nearest to `middle` that is.
double moved_inside(double middle, double fade, double length) {
    return std::clamp(middle, fade / 2, std::max(fade / 2, length - fade / 2));
}

}  // namespace

Crossing best_crossing(const MatrixFView& entry, const MatrixFView& exit, double fade_entry,
                       double fade_exit) {
    const auto entry_rows = static_cast<double>(entry.rows());
    const auto exit_rows = static_cast<double>(exit.rows());
    Crossing best{entry_rows / 2, exit_rows / 2};
    double least = HUGE_VAL;
    const std::vector<WarpCell> cells = warp(entry, exit).cells;
    std::vector<double> sums = {0};  // of squared distances, of the cells before
    for (const WarpCell& cell : cells) {
        const double distance =
            static_cast<double>((entry.row(cell.first) - exit.row(cell.second)).squaredNorm());
        sums.push_back(sums.back() + distance);
    }
    size_t begin = 0, end = 0;  // of the cells that a fade about the cell at hand passes
    for (const WarpCell& cell : cells) {
        const Crossing middle{cell.first + 0.5, cell.second + 0.5};
        while (cells[begin].first < cell.first - fade_entry / 2) ++begin;
        while (end < cells.size() && cells[end].first <= cell.first + fade_entry / 2) ++end;
        if (!is_inside(middle.entry, fade_entry, entry_rows) ||
            !is_inside(middle.exit, fade_exit, exit_rows)) {
            continue;
        }
        const double mean = (sums[end] - sums[begin]) / static_cast<double>(end - begin);
        if (mean < least) best = middle;
        least = std::min(least, mean);
    }
    return best;
}

Crossing fade_lengths(const MotionPiece& entry, const MotionPiece& exit, double fade_frames) {
    const auto in = static_cast<double>(entry.frames());
    const auto out = static_cast<double>(exit.frames());
    const double share = std::min(1.0, 2 * fade_frames / (in + out));
    return {in * share, out * share};
}

std::vector<MotionRun> runs_of_walk(
    const MotionGraph& graph, const std::vector<WalkStep>& steps, double fade_frames,
    const std::function<Crossing(int32_t entry, int32_t exit)>& crossing) {
    std::vector<MotionRun> runs;
    for (const WalkStep& step : steps) {
        const MotionRun entry = run_of(graph.piece(step.entry));
        const MotionRun exit = run_of(graph.piece(step.exit));
        if (runs.empty()) runs.push_back(entry);
        runs.back().end = entry.end;
        if (step.entry == step.exit) continue;
        const Crossing fade =
            fade_lengths(graph.piece(step.entry), graph.piece(step.exit), fade_frames);
        const Crossing middle = crossing(step.entry, step.exit);
        runs.back().end = entry.first + fade.entry / 2 +
                          moved_inside(middle.entry, fade.entry, entry.end - entry.first);
        runs.back().fade_out = fade.entry;
        runs.push_back(exit);
        runs.back().first +=
            moved_inside(middle.exit, fade.exit, exit.end - exit.first) - fade.exit / 2;
        runs.back().fade_in = fade.exit;
    }
    return runs;
}

std::vector<MotionRun> runs_of_walk(const MotionGraph& graph, const std::vector<WalkStep>& steps,
                                    double fade_frames) {
    const auto middle = [&](int32_t piece) {
        return static_cast<double>(graph.piece(piece).frames()) / 2;
    };
    return runs_of_walk(graph, steps, fade_frames, [&](int32_t entry, int32_t exit) {
        return Crossing{middle(entry), middle(exit)};
    });
}

}  // namespace kinetome
