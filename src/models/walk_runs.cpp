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

/// Where the second sequence is when the first is at `moment`, by a warp of all rows of both.
double answer(const std::vector<WarpCell>& cells, double moment, double first_rows,
              double second_rows) {
    const auto at = [&](size_t i) {  // middles of cells, between the beginnings and the ends
        if (i == 0) return std::pair(0.0, 0.0);
        if (i > cells.size()) return std::pair(first_rows, second_rows);
        return std::pair(cells[i - 1].first + 0.5, cells[i - 1].second + 0.5);
    };
    size_t next = 1;
    while (next <= cells.size() && at(next).first < moment) ++next;
    const auto [first, second] = at(next - 1);
    const auto [next_first, next_second] = at(next);
    return std::lerp(second, next_second, (moment - first) / (next_first - first));
}

/// Even shares of the first sequence's rows from `first` to `end`, and the shares of the second's
/// that answer them: each the mean over an eighth to either side, so that speeds do not jump.
std::vector<double> registration(const std::vector<WarpCell>& cells, double first, double end,
                                 double first_rows, double second_rows) {
    constexpr int pieces = 16, reach = 2;
    std::vector<double> answers, shares;
    for (int i = 0; i <= pieces; ++i) {
        answers.push_back(answer(cells, std::lerp(first, end, static_cast<double>(i) / pieces),
                                 first_rows, second_rows));
    }
    for (int i = 0; i <= pieces; ++i) {
        const int near = std::min({reach, i, pieces - i});  // the ends stay where they are
        double sum = 0;
        for (int j = i - near; j <= i + near; ++j) sum += answers[static_cast<size_t>(j)];
        shares.push_back(sum / (2 * near + 1));
    }
    const double from = shares.front(), length = shares.back() - from;
    if (!(length > 0)) return {};
    for (double& share : shares) share = (share - from) / length;
    shares.back() = 1;
    return shares;
}

}  // namespace

Crossing best_crossing(const MatrixFView& entry, const MatrixFView& exit, double fade_entry,
                       double fade_exit) {
    const auto entry_rows = static_cast<double>(entry.rows());
    const auto exit_rows = static_cast<double>(exit.rows());
    Crossing best{.entry = entry_rows / 2, .exit = exit_rows / 2};
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
        const Crossing middle{.entry = cell.first + 0.5, .exit = cell.second + 0.5};
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
    if (cells.empty()) return best;
    const double first = best.entry - fade_entry / 2;
    best.registration = registration(cells, first, first + fade_entry, entry_rows, exit_rows);
    return best;
}

Crossing fade_lengths(const MotionPiece& entry, const MotionPiece& exit, double fade_frames) {
    const auto in = static_cast<double>(entry.frames());
    const auto out = static_cast<double>(exit.frames());
    const double share = std::min(1.0, 2 * fade_frames / (in + out));
    return {.entry = in * share, .exit = out * share};
}

namespace {

/// Goes over from the last run to the exit, about the middle of the crossing.
void go_over(std::vector<MotionRun>& runs, const MotionRun& entry, const MotionRun& exit,
             const Crossing& fade, const Crossing& middle) {
    const double out =
        entry.first + moved_inside(middle.entry, fade.entry, entry.end - entry.first);
    const double in = exit.first + moved_inside(middle.exit, fade.exit, exit.end - exit.first);
    runs.push_back(exit);
    MotionRun& before = runs[runs.size() - 2];
    MotionRun& after = runs.back();
    if (fade.entry + fade.exit == 0) {
        before.end = std::nearbyint(out);
        after.first = std::nearbyint(in);
        return;
    }
    // From whole frames to whole frames, in as much time as it would take without.
    constexpr double rounding = 1e-9;
    const double begin = std::max(std::floor(out - fade.entry / 2 + rounding), entry.first);
    const double end = std::min(std::ceil(in + fade.exit / 2 - rounding), exit.end);
    before.end = out + fade.entry / 2;
    before.fade_out = before.end - begin;
    after.first = in - fade.exit / 2;
    after.fade_in = end - after.first;
    after.registration = middle.registration;
    const double sooner = before.fade_out - fade.entry, later = after.fade_in - fade.exit;
    const double natural = natural_fade_frames(fade.entry, fade.exit, middle.registration);
    after.fade_frames = std::ceil(natural * middle.slowness + sooner + later - rounding);
}

}  // namespace

std::vector<MotionRun> runs_of_walk(
    const MotionGraph& graph, const std::vector<WalkStep>& steps, double fade_frames,
    const std::function<Crossing(int32_t entry, int32_t exit)>& crossing) {
    std::vector<MotionRun> runs;
    for (const WalkStep& step : steps) {
        const MotionPiece& entry = graph.piece(step.entry);
        const MotionPiece& exit = graph.piece(step.exit);
        if (runs.empty()) runs.push_back(run_of(entry));
        runs.back().end = static_cast<double>(entry.end);
        if (step.entry == step.exit) continue;
        go_over(runs, run_of(entry), run_of(exit), fade_lengths(entry, exit, fade_frames),
                crossing(step.entry, step.exit));
    }
    return runs;
}

std::vector<MotionRun> runs_of_walk(const MotionGraph& graph, const std::vector<WalkStep>& steps,
                                    double fade_frames) {
    const auto middle = [&](int32_t piece) {
        return static_cast<double>(graph.piece(piece).frames()) / 2;
    };
    return runs_of_walk(graph, steps, fade_frames, [&](int32_t entry, int32_t exit) {
        return Crossing{.entry = middle(entry), .exit = middle(exit)};
    });
}

}  // namespace kinetome
