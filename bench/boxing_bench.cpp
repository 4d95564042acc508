// Are punches of the left and the right kept apart, by the number of pose clusters (S1 §3.6), and
// which bundles hold them (S1 Figure 4)?
//
//   boxing_bench TAKE [--starts N] [--each] [--threads N]
//       TAKE: an AMC of boxing, with its skeleton beside it; CMU's 14_02 is very likely S1's
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "found_bundles.h"
#include "program.h"

namespace {

using namespace kinetome;
namespace fs = std::filesystem;

struct Options {
    fs::path take;
    int starts = 6;
    bool each = false;
    int threads = 2;
};

constexpr std::array side_names = {"left", "right"};

/// How far the wrist is from the shoulder, cm, by frame.
std::vector<double> reach(const Clip& clip, const MatrixF& positions, JointRole wrist,
                          JointRole shoulder) {
    const auto place = [&](int64_t frame, JointRole role) {
        return positions.row(frame).segment<3>(3 * clip.skeleton->role(role));
    };
    std::vector<double> distances;
    for (int64_t frame = 0; frame < clip.frames(); ++frame)
        distances.push_back((place(frame, wrist) - place(frame, shoulder)).norm());
    return distances;
}

/// An arm that is stretched by three quarters of its reach for a moment: from where it passes the
/// half on its way out to where it does on its way back, less than three quarters of a second.
std::vector<RowRange> punches(const std::vector<double>& reach) {
    constexpr double stretched = 0.75, half = 0.5, longest_seconds = 0.75;
    const auto [least, most] = std::ranges::minmax(reach);
    const auto level = [low = least, range = most - least](double share) {
        return low + share * range;
    };
    const auto frames = static_cast<int64_t>(reach.size());
    const auto is_above = [&](int64_t frame, double share) {
        return frame >= 0 && frame < frames && reach[static_cast<size_t>(frame)] >= level(share);
    };
    std::vector<RowRange> found;
    for (int64_t frame = 0; frame < frames; ++frame) {
        if (!is_above(frame, stretched)) continue;
        RowRange punch{frame, frame + 1};
        while (is_above(punch.first - 1, half)) --punch.first;
        while (is_above(punch.end, half)) ++punch.end;
        if (static_cast<double>(punch.size()) < longest_seconds * bench::pose_rate)
            found.push_back(punch);
        frame = punch.end;
    }
    return found;
}

/// Punches of both sides, and the side of each frame; where both punch, it has none.
struct Sides {
    std::array<std::vector<RowRange>, 2> punches;
    FrameClasses of_frames;

    explicit Sides(const Clip& clip) : of_frames(static_cast<size_t>(clip.frames()), no_class) {
        const MatrixF positions = joint_positions(clip);
        constexpr std::array wrists = {JointRole::left_wrist, JointRole::right_wrist};
        constexpr std::array shoulders = {JointRole::left_shoulder, JointRole::right_shoulder};
        std::vector<bool> both(of_frames.size());
        for (size_t side = 0; side < wrists.size(); ++side) {
            punches[side] = ::punches(reach(clip, positions, wrists[side], shoulders[side]));
            for (const RowRange& punch : punches[side]) {
                for (auto frame = static_cast<size_t>(punch.first);
                     frame < static_cast<size_t>(punch.end); ++frame) {
                    both[frame] = of_frames[frame] != no_class;
                    of_frames[frame] = static_cast<int32_t>(side);
                }
            }
        }
        for (size_t frame = 0; frame < both.size(); ++frame) {
            if (both[frame]) of_frames[frame] = no_class;
        }
    }
};

/// What a bundle holds of punches.
struct Punching {
    int64_t height = 0;
    double width = 0;
    std::array<int64_t, 2> frames{};

    int64_t of_punches() const { return frames[0] + frames[1]; }
    size_t side() const { return frames[1] > frames[0] ? 1 : 0; }
    std::string text() const {
        return fmt::format("{}x{:.0f} {}", height, width, side_names[side()]);
    }
};

std::vector<Punching> punching(const MotionString& string,
                               const std::vector<SubstringBundle>& bundles, const Sides& sides) {
    std::vector<Punching> all;
    for (const SubstringBundle& bundle : bundles) {
        if (bundle.is_degenerate()) break;
        Punching& one = all.emplace_back();
        one.height = bundle.height();
        for (const Substring& member : bundle.members) {
            const auto first = static_cast<size_t>(string.mean_frame(member.first));
            const auto end = static_cast<size_t>(string.mean_frame(member.last));
            one.width += static_cast<double>(end - first) / static_cast<double>(one.height);
            for (size_t frame = first; frame < end; ++frame) {
                const int32_t side = sides.of_frames[frame];
                if (side != no_class) ++one.frames[static_cast<size_t>(side)];
            }
        }
    }
    return all;
}

/// Those that punches fill by a third or more, the most punching first.
std::vector<Punching> of_punches(std::vector<Punching> all) {
    std::erase_if(all, [](const Punching& one) {
        return 3 * one.of_punches() < static_cast<double>(one.height) * one.width;
    });
    std::ranges::stable_sort(all, std::ranges::greater(), &Punching::of_punches);
    return all;
}

/// The first four: " 12x30 right 4x22 left".
std::string largest(const std::vector<Punching>& all) {
    std::string text;
    for (size_t i = 0; i < std::min<size_t>(all.size(), 4); ++i) text += " " + all[i].text();
    return text;
}

/// Of several starts' bundles the most punching of either side.
struct Best {
    std::array<Punching, 2> of_sides;

    void consider(const std::vector<Punching>& all) {
        for (const Punching& one : all) {
            Punching& best = of_sides[one.side()];
            if (one.of_punches() > best.of_punches()) best = one;
        }
    }
};

struct Settings {
    const char* name;
    MotionBundleOptions bundles;
    MotionStringOptions spelling;
};

void print(const Options& options) {
    const Clip clip = resample(bench::read_take(options.take), bench::pose_rate);
    const Sides sides(clip);
    const auto takes = bench::PoseTakes::of_clips({options.take.stem().string()}, {clip});
    fmt::print("{} frames, {} punches of the left, {} of the right\n", clip.frames(),
               sides.punches[0].size(), sides.punches[1].size());
    fmt::print(
        "mixed: of the punches' frames in bundles, those on the side that fewer of their\n"
        "bundle's are on; mean and most of {} starts of EM; of all starts the two bundles with\n"
        "most frames of punches, and those of the first\n",
        options.starts);
    fmt::print(
        "options         kappa frames/cluster  mixed   most cover. left         right         "
        "bundles that are punches\n");
    const std::array<Settings, 5> all = {
        {{"default", {}, {}},
         {"depth:2", {.depth = 2}, {}},
         {"depth:2, mean", {.depth = 2, .member_length = MemberLength::mean}, {}},
         {"S1's τ, depth:2", {.depth = 2, .step_quantile = 1}, {.tau_quantile = 0.5}},
         {"paper",
          {.spread = BundleSpread::closure,
           .step_quantile = 1,
           .member_length = MemberLength::mean},
          {.tau_quantile = 0.5}}}};
    for (const Settings& settings : all) {
        for (const int64_t clusters : {500, 250, 175, 100, 75, 50, 25, 12}) {
            double mean = 0, most = 0, coverage = 0;
            std::string bundles_of_first;
            Best best;
            for (int start = 1; start <= options.starts; ++start) {
                PoseClusterOptions poses;
                poses.clusters = clusters;
                poses.mixture.seed = static_cast<uint64_t>(start);
                const bench::SpelledTakes spelled(takes, poses, options.threads, settings.spelling);
                const auto found = punching(
                    spelled.string, bench::find(spelled, settings.bundles, options.threads).bundles,
                    sides);
                int64_t mixed = 0, covered = 0, frames = 0;
                for (const Punching& one : found) {
                    mixed += std::ranges::min(one.frames);
                    covered += one.of_punches();
                }
                frames = std::ranges::count_if(sides.of_frames,
                                               [](int32_t side) { return side != no_class; });
                const double share =
                    static_cast<double>(mixed) / static_cast<double>(std::max<int64_t>(covered, 1));
                mean += share / options.starts;
                most = std::max(most, share);
                coverage +=
                    static_cast<double>(covered) / static_cast<double>(frames) / options.starts;
                const auto punches = of_punches(found);
                if (start == 1) bundles_of_first = largest(punches);
                best.consider(punches);
                if (options.each)
                    fmt::print("    start {:>2}: {:.3f} mixed,{}\n", start, share,
                               largest(punches));
            }
            fmt::print("{:<15} {:>5} {:>14.0f} {:>6.3f} {:>6.3f} {:>6.3f} {:<12} {:<12} {}\n",
                       settings.name, clusters,
                       static_cast<double>(clip.frames()) / static_cast<double>(clusters), mean,
                       most, coverage, best.of_sides[0].text(), best.of_sides[1].text(),
                       bundles_of_first);
            std::fflush(stdout);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    bench::Program program("Bundles of punches: left and right by number of clusters (S1 3.6)");
    program.argument("TAKE", options.take, "AMC of boxing, its skeleton beside it");
    program.count("--starts", options.starts, "of EM");
    program.flag("--each", options.each, "start's bundles, not the first's alone");
    program.count("--threads", options.threads, "threads");
    return program.run(argc, argv, [&] {
        print(options);
        return true;
    });
}
