#include "kinetome/models/motion_walk.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kinetome/models/motion_blend.h"
#include "registration.h"

namespace kinetome {
namespace {

/// Of sums of lengths, in frames.
constexpr double rounding = 1e-6;

double smoothstep(double share) {
    return share * share * (3 - 2 * share);
}

/// The integral of smoothstep from 0.
double smoothstep_area(double share) {
    const double cube = share * share * share;
    return cube - cube * share / 2;
}

/// Rises from 0 to 1, level at both ends and bent at neither.
double smootherstep(double share) {
    return share * share * share * (10 - share * (15 - 6 * share));
}

/// Going over from one side to the other. Time passes with the share s of the side that goes out as
/// dt/ds = (1 - w) out + w in dr/ds, w = smoothstep(s), r(s) the share of the other side that
/// answers: so it goes at the speed of each side where only that side is seen. What it lasts longer
/// than that takes is added in the middle.
class Fade {
  public:
    Fade() = default;
    /// Without `frames` as long as that takes.
    Fade(double out, double in, std::span<const double> registration, double frames = 0)
        : out_(out), in_(in), registration_(registration), frames_(natural_time(1)) {
        if (frames > 0) added_ = frames - frames_;
        frames_ += added_;
    }

    double frames() const { return frames_; }
    double added() const { return added_; }
    double in_share(double share) const { return registered_share(registration_, share); }
    /// The inverse of time, by bisection: time rises with the share, however unlike the sides are.
    double share(double at) const {
        double low = 0, high = 1;
        for (int i = 0; i < 52; ++i) {
            const double middle = (low + high) / 2;
            (natural_time(middle) + added_ * smootherstep(middle) <= at ? low : high) = middle;
        }
        return low;
    }

  private:
    double natural_time(double share) const {
        const double seen_out = out_ * (share - smoothstep_area(share));
        if (registration_.empty()) return seen_out + in_ * smoothstep_area(share);
        const auto pieces = static_cast<double>(registration_.size() - 1);
        double seen_in = 0, area = 0;
        for (size_t knot = 0; knot + 1 < registration_.size(); ++knot) {
            const double before = area;
            const double end = std::min(static_cast<double>(knot + 1) / pieces, share);
            area = smoothstep_area(end);
            seen_in += (registration_[knot + 1] - registration_[knot]) * pieces * (area - before);
            if (end == share) break;
        }
        return seen_out + in_ * seen_in;
    }

    double out_ = 0, in_ = 0;                    ///< frames of the two sides
    std::span<const double> registration_ = {};  ///< MotionRun::registration
    double frames_ = 0, added_ = 0;
};

/// One run on the time line of the whole.
struct TimedRun {
    MotionRun run;
    Fade before, after;
    double start = 0, end = 0;  ///< frames of the whole, not rounded; its fades among them

    /// Frame of the clip at frame `at` of the whole; at one speed before the start.
    double moment(double at) const {
        const double time = at - start;
        if (time < 0) return run.first + time;
        if (time < before.frames())
            return run.first + run.fade_in * before.in_share(before.share(time));
        const double left = end - at;
        if (left < after.frames()) {
            return run.end - run.fade_out * (1 - after.share(after.frames() - left));
        }
        const double alone = run.first + run.fade_in + (time - before.frames());
        const double whole = std::nearbyint(alone);
        return std::abs(alone - whole) < rounding ? whole : alone;
    }
    double weight(double at) const {
        const double time = at - start, left = end - at;
        double weight = 1;
        if (time < before.frames()) weight = smoothstep(before.share(time));
        if (left < after.frames()) {
            weight = std::min(weight, 1 - smoothstep(after.share(after.frames() - left)));
        }
        return weight;
    }
};

/// The fade into a run from the one before.
Fade fade_into(std::span<const MotionRun> runs, size_t at) {
    if (at == 0 || at == runs.size()) return {};
    const MotionRun& run = runs[at];
    return {runs[at - 1].fade_out, run.fade_in, run.registration, run.fade_frames};
}

std::vector<TimedRun> on_time_line(std::span<const MotionRun> runs) {
    std::vector<TimedRun> timed;
    double start = 0;
    for (size_t i = 0; i < runs.size(); ++i) {
        const MotionRun& run = runs[i];
        const Fade before = fade_into(runs, i), after = fade_into(runs, i + 1);
        const double alone = run.end - run.first - run.fade_in - run.fade_out;
        const double end = start + before.frames() + alone + after.frames();
        timed.push_back({run, before, after, start, end});
        start = end - after.frames();
    }
    return timed;
}

/// Hands each frame of the whole over with the runs that are seen in it.
template <class Visit>
void for_each_frame(std::span<const MotionRun> runs, const Visit& visit) {
    const auto timed = on_time_line(runs);
    size_t begin = 0, end = 0;
    for (double at = 0; at < timed.back().end - rounding; ++at) {
        while (timed[begin].end <= at) ++begin;
        while (end < timed.size() && timed[end].start <= at) ++end;
        visit(at, std::span(timed).subspan(begin, end - begin));
    }
}

void check(std::span<const Clip> clips, std::span<const MotionRun> runs) {
    if (runs.empty()) throw std::invalid_argument("there are no motions to join");
    for (const MotionRun& run : runs) {
        if (run.clip < 0 || static_cast<size_t>(run.clip) >= clips.size()) {
            throw std::invalid_argument("a run names a clip that is not there");
        }
        const Clip& clip = clips[static_cast<size_t>(run.clip)];
        const Clip& first = clips[static_cast<size_t>(runs.front().clip)];
        if (clip.rate != first.rate || clip.skeleton != first.skeleton) {
            throw std::invalid_argument("motions to be joined must have one skeleton and one rate");
        }
        const double alone = run.end - run.first - run.fade_in - run.fade_out;
        if (!(alone >= -rounding && run.fade_in >= 0 && run.fade_out >= 0 &&
              run.fade_frames >= 0)) {
            throw std::invalid_argument("a run is shorter than its fades");
        }
        check_registration(run.registration);
    }
    for (size_t i = 1; i < runs.size(); ++i) {
        if (fade_into(runs, i).added() < -rounding)
            throw std::invalid_argument("a fade is shorter than its motions take");
    }
    if (runs.front().fade_in != 0 || runs.back().fade_out != 0) {
        throw std::invalid_argument("the ends of a motion have nothing to fade with");
    }
}

}  // namespace

double natural_fade_frames(double fade_out, double fade_in, std::span<const double> registration) {
    return Fade(fade_out, fade_in, registration).frames();
}

std::vector<RunTime> times_of_runs(std::span<const MotionRun> runs) {
    std::vector<RunTime> times;
    for (const TimedRun& run : on_time_line(runs)) times.push_back({run.start, run.end});
    return times;
}

double frames_of_runs(std::span<const MotionRun> runs) {
    return runs.empty() ? 0 : on_time_line(runs).back().end;
}

Clip play_runs(std::span<const Clip> clips, std::span<const MotionRun> runs,
               const ClipSupports& supports) {
    check(clips, runs);
    const Clip& first = clips[static_cast<size_t>(runs.front().clip)];
    MotionBlend blend(first.skeleton, first.rate);
    std::vector<MotionShare> shares;
    for_each_frame(runs, [&](double at, std::span<const TimedRun> seen) {
        shares.clear();
        for (const TimedRun& run : seen) {
            const auto clip = static_cast<size_t>(run.run.clip);
            const double moment = run.moment(at);
            shares.push_back({.clip = &clips[clip],
                              .moment = moment,
                              .moment_before = run.moment(at - 1),
                              .weight = run.weight(at)});
            if (!supports.empty()) shares.back().support = support_at(supports[clip], moment);
        }
        blend.append(shares);
    });
    return blend.clip();
}

std::vector<FrameSource> sources_of_runs(std::span<const MotionRun> runs) {
    std::vector<FrameSource> sources;
    for_each_frame(runs, [&](double at, std::span<const TimedRun> seen) {
        const TimedRun& most = *std::ranges::max_element(
            seen, {}, [=](const TimedRun& run) { return run.weight(at); });
        sources.push_back({most.run.clip, std::llround(most.moment(at))});
    });
    return sources;
}

std::vector<MotionRun> runs_of_pieces(std::span<const MotionPiece> pieces, double fade_frames) {
    std::vector<MotionRun> runs;
    const auto continues = [](const MotionRun& run, const MotionPiece& piece) {
        return run.clip == piece.clip && run.end == static_cast<double>(piece.first);
    };
    for (const MotionPiece& piece : pieces) {
        if (!runs.empty() && continues(runs.back(), piece)) {
            runs.back().end = static_cast<double>(piece.end);
        } else {
            runs.push_back({.clip = piece.clip,
                            .first = static_cast<double>(piece.first),
                            .end = static_cast<double>(piece.end)});
        }
    }
    for (size_t i = 0; i + 1 < runs.size(); ++i) {
        MotionRun& before = runs[i];
        MotionRun& after = runs[i + 1];
        const double shorter =
            std::min(before.end - before.first - before.fade_in / 2, after.end - after.first);
        const double reach = std::min(fade_frames, shorter) / 2;
        before.end += reach;
        after.first -= reach;
        before.fade_out = after.fade_in = 2 * reach;
    }
    return runs;
}

}  // namespace kinetome
