#include "kinetome/models/truth_timeline.h"

#include <algorithm>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"

namespace kinetome {
namespace {

/// Where one activity passes into the next, and how far from there it may be.
struct Boundary {
    int64_t lo, mid, hi;
};

/// `before` and `after` are the boundaries next to it, or the ends of the take.
Boundary in_order(const Boundary& boundary, int64_t before, int64_t after) {
    const auto [lo, mid, hi] = boundary;
    return {lo < before ? mid : std::min(lo, mid), mid, hi > after ? mid : std::max(hi, mid)};
}

Boundary with_balanced_sides(const Boundary& boundary, double rate) {
    const auto [lo, mid, hi] = boundary;
    const auto much_wider = [rate](int64_t side, int64_t other) {
        return double(side) > 3.0 * double(other) + 2.5 * rate;
    };
    const int64_t left = mid - lo, right = hi - mid;
    return {much_wider(left, right) ? mid - right : lo, mid,
            much_wider(right, left) ? mid + left : hi};
}

/// The boundaries between the rows of a take, mended.
std::vector<Boundary> boundaries_of(std::span<const TruthRow> rows, int64_t frames, double rate) {
    std::vector<Boundary> boundaries;
    for (size_t i = 0; i + 1 < rows.size(); ++i) {
        const Boundary drawn = {rows[i].end_lo, rows[i].end, rows[i].end_hi};
        const int64_t after = i + 2 < rows.size() ? rows[i + 1].end : frames;
        boundaries.push_back(with_balanced_sides(in_order(drawn, rows[i].first, after), rate));
    }
    return boundaries;
}

void require_rows_that_follow(std::span<const TruthRow> rows, int64_t frames,
                              const std::string& path) {
    int64_t end = 0;
    for (const TruthRow& row : rows) {
        const auto refuse = [&](const std::string& reason) {
            throw InputError::at_line(path, row.line,
                                      "clip " + quote_for_message(row.clip) + " " + reason);
        };
        if (row.first < end) {
            refuse("has a label from frame " + std::to_string(row.first) +
                   ", but the one before lasts until " + std::to_string(end) +
                   ": sort the rows by frame and let each begin where the one before ends");
        }
        if (row.first > end) {
            refuse("has no label from frame " + std::to_string(end) + " to " +
                   std::to_string(row.first) + ": give these frames one, 'other' if need be");
        }
        if (row.end <= row.first) {
            refuse("has an activity without frames, from " + std::to_string(row.first) + " to " +
                   std::to_string(row.end));
        }
        if (row.end > frames) {
            refuse("has a label until frame " + std::to_string(row.end) + ", but " +
                   std::to_string(frames) + " frames: is the annotation at the clip's rate?");
        }
        end = row.end;
    }
}

int32_t class_number(std::vector<std::string>& classes, const std::string& label) {
    const auto found = std::find(classes.begin(), classes.end(), label);
    const auto number = static_cast<int32_t>(found - classes.begin());
    if (found == classes.end()) classes.push_back(label);
    return number;
}

}  // namespace

std::vector<int32_t> TruthTimeline::class_of_frames() const {
    std::vector<int32_t> labels(static_cast<size_t>(frames()));
    for (const TrueActivity& activity : activities) {
        std::fill(labels.begin() + activity.frames.first, labels.begin() + activity.frames.end,
                  activity.label);
    }
    return labels;
}

std::vector<char> TruthTimeline::uncertain_frames() const {
    std::vector<char> uncertain(static_cast<size_t>(frames()), false);
    for (const RowRange& zone : zones) {
        std::fill(uncertain.begin() + zone.first, uncertain.begin() + zone.end, true);
    }
    return uncertain;
}

TruthTimeline truth_timeline(std::span<const TruthRow> rows, int64_t frames, double rate,
                             const std::string& path) {
    TruthTimeline truth;
    if (rows.empty()) return truth;
    require_rows_that_follow(rows, frames, path);
    int64_t first = 0;
    for (const Boundary& boundary : boundaries_of(rows, frames, rate)) {
        const int32_t label = class_number(truth.classes, rows[truth.activities.size()].label);
        truth.activities.push_back({{first, boundary.mid}, label});
        truth.zones.push_back({boundary.lo, boundary.hi});
        first = boundary.mid;
    }
    truth.activities.push_back({{first, frames}, class_number(truth.classes, rows.back().label)});
    return truth;
}

}  // namespace kinetome
