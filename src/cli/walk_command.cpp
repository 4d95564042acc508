#include <fmt/format.h>

#include <optional>

#include "checks.h"
#include "command.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"
#include "kinetome/formats/write_amc.h"
#include "kinetome/formats/write_bvh.h"
#include "kinetome/stages/node_blend.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/primitive_walk.h"
#include "kinetome/stages/stored_bundles.h"

namespace kinetome::cli {
namespace {

namespace fs = std::filesystem;

constexpr double longest_walk = 3600;  // seconds: the motion is held in memory

struct WalkFlags {
    fs::path store, output, labels;
    std::string graph = "primitives", registration = "warp", generation = "current";
    WalkOptions walk;
    std::optional<double> seconds, fade;
    std::string blend;
    std::vector<double> weights;
};

enum class MotionFormat { bvh, amc };

MotionFormat format_of(const fs::path& output) {
    if (output.extension() == ".bvh") return MotionFormat::bvh;
    if (output.extension() == ".amc") return MotionFormat::amc;
    throw UsageError(fmt::format("-o {}: expected a name that ends in .bvh or .amc",
                                 path_for_message(output.string())));
}

std::string asf_text(const Skeleton& skeleton) {
    try {
        return write_asf(skeleton);
    } catch (const std::invalid_argument& error) {
        throw UsageError(
            fmt::format("ASF cannot hold this skeleton ({}); write a .bvh instead", error.what()));
    }
}

/// An AMC file means nothing without its skeleton, which is written beside it: not over another
/// one, that other takes may need.
void write_amc_and_asf(const Clip& motion, const fs::path& output) {
    fs::path path = output;
    path.replace_extension(".asf");
    const std::string skeleton = asf_text(*motion.skeleton);
    if (fs::exists(path) && read_file(path) != skeleton) {
        throw CreateError(fmt::format("{} is the skeleton of something else; give -o another name",
                                      path_for_message(path.string())));
    }
    const std::string frames = write_amc(motion);
    const FileText files[] = {{path, skeleton}, {output, frames}};
    write_files_atomically(files);
}

/// The nodes passed, each with how often in a row.
std::string path_text(const std::vector<std::string>& nodes) {
    std::string text;
    for (size_t i = 0; i < nodes.size();) {
        size_t end = i + 1;
        while (end < nodes.size() && nodes[end] == nodes[i]) ++end;
        text += (text.empty() ? "" : " → ") + nodes[i];
        if (end - i > 1) text += fmt::format(" × {}", end - i);
        i = end;
    }
    return text;
}

void print_walk(const PrimitiveWalk& walk) {
    const WalkQuality& quality = walk.quality;
    fmt::print("path          {}\n", path_text(walk.nodes));
    fmt::print("motion        {} frames at {:g} a second, on the body of {}\n",
               walk.motion.frames(), walk.motion.rate, walk.body);
    fmt::print("foot slide    {:.2f} cm a second of contact (in the takes {:.2f})\n",
               quality.slide.speed(), quality.slide_in_takes.speed());
    fmt::print("pose step     {:.0f} cm/s at most (in the takes {:.0f})\n", quality.pose_step,
               quality.pose_step_in_takes);
    fmt::print("fastest joint {:.0f} cm/s (in the takes {:.0f})\n", quality.peaks.speed,
               quality.peaks_in_takes.speed);
    fmt::print("hardest jolt  {:.0f} cm/s² (in the takes {:.0f})\n", quality.peaks.acceleration,
               quality.peaks_in_takes.acceleration);
}

void warn_of_early_end(const PrimitiveWalk& walk, const WalkOptions& options, const Log& log) {
    if (!walk.ended_early) return;
    log.warning(
        "the walk ends after {:.1f} of {:g} s: nothing follows {}{}; another --seed or "
        "--from may last longer",
        static_cast<double>(walk.motion.frames()) / walk.motion.rate, options.seconds,
        walk.nodes.back(), options.to.empty() ? "" : " that leads back to --to");
}

void print_blend(const NodeBlend& blend) {
    fmt::print("blend         {}\n", blend.node);
    for (size_t i = 0; i < blend.parts.size(); ++i) {
        const ClipPrimitive& part = blend.parts[i];
        fmt::print("  {:.3f}       {} {}:{}\n", blend.weights[i], quote_for_message(part.clip),
                   part.first, part.end);
    }
    fmt::print("motion        {} frames at {:g} a second, on the body of {}\n",
               blend.motion.frames(), blend.motion.rate, blend.body);
    fmt::print("pose step     {:.0f} cm/s at most (in the parts {:.0f})\n", blend.pose_step,
               blend.pose_step_of_parts);
    fmt::print("fastest joint {:.0f} cm/s (in the parts {:.0f})\n", blend.peaks.speed,
               blend.peaks_of_parts.speed);
}

void check(const WalkFlags& flags) {
    if (flags.graph != "primitives" && flags.graph != "bundles") {
        throw UsageError(fmt::format("--graph {}: expected primitives or bundles", flags.graph));
    }
    if (flags.registration != "warp" && flags.registration != "even") {
        throw UsageError(
            fmt::format("--registration {}: expected warp or even", flags.registration));
    }
    if (flags.seconds && !(*flags.seconds > 0 && *flags.seconds <= longest_walk)) {
        throw UsageError(fmt::format("--seconds {:g}: expected more than 0 and at most {}",
                                     *flags.seconds, longest_walk));
    }
    if (flags.blend.empty() && !flags.weights.empty()) {
        throw UsageError("--weights are those of --blend");
    }
    if (!flags.blend.empty() && flags.seconds) {
        throw UsageError("--blend lasts as long as its motions do: it takes no --seconds");
    }
    if (!flags.blend.empty() && !(flags.walk.from.empty() && flags.walk.to.empty())) {
        throw UsageError("--blend stays in one node: it goes neither --from nor --to others");
    }
}

void write_motion(const Clip& motion, MotionFormat format, const fs::path& output) {
    if (format == MotionFormat::bvh) {
        write_file_atomically(output, write_bvh(motion));
    } else {
        write_amc_and_asf(motion, output);
    }
}

ExitCode walk(const WalkFlags& flags, const Invocation& invocation) {
    check(flags);
    const MotionFormat format = format_of(flags.output);
    const OpenStore open(flags.store, flags.generation);
    const bool bundles = flags.graph == "bundles";
    WalkOptions options = flags.walk;
    if (bundles) options = options_of_bundle_walk(options);
    options.registered = flags.registration == "warp";
    if (flags.seconds) options.seconds = *flags.seconds;
    if (flags.fade) options.fade_seconds = *flags.fade;
    const auto pieces =
        bundles ? stored_bundle_members(open, flags.labels) : stored_primitives(open, flags.labels);
    const ClipSource source = clip_source(open.generation);
    if (!flags.blend.empty()) {
        const NodeBlend made = blend_node(pieces, source,
                                          {.node = flags.blend,
                                           .weights = flags.weights,
                                           .registered = options.registered,
                                           .body = options.body,
                                           .style = options.style});
        write_motion(made.motion, format, flags.output);
        print_blend(made);
        return ExitCode::success;
    }
    const PrimitiveWalk made = walk_primitives(
        pieces, source, options,
        bundles ? stored_bundle_links(open.generation) : std::vector<ClusterLink>{});
    write_motion(made.motion, format, flags.output);
    print_walk(made);
    warn_of_early_end(made, options, invocation.log);
    return ExitCode::success;
}

}  // namespace

Command walk_command() {
    return {
        "walk", "put a new motion together from the primitives or the bundles of a store",
        "kinetome walk motion.store --graph primitives --seconds 30 --seed 1 --from walk "
        "-o walk.bvh",
        [](CLI::App& app) -> Run {
            auto flags = std::make_shared<WalkFlags>();
            WalkOptions& options = flags->walk;
            app.add_option("STORE", flags->store, "store to read")->required();
            app.add_option("-o,--output", flags->output,
                           "file to write: .bvh, or .amc with its .asf beside it")
                ->required();
            app.add_option("--graph", flags->graph,
                           "what the walk leads through: primitives or bundles")
                ->capture_default_str();
            app.add_option("--seconds", flags->seconds,
                           fmt::format("wanted length, at most {} (default: {:g})", longest_walk,
                                       options.seconds));
            app.add_option("--seed", options.seed, "the same seed walks the same way")
                ->check(zero_or_above())
                ->capture_default_str();
            app.add_option("--from", options.from, "label, cluster or bundle to begin with");
            app.add_option("--to", options.to, "label, cluster or bundle to end with");
            app.add_option(
                "--labels", flags->labels,
                "of what the walk leads through: clip,first,end,label, such as `kinetome "
                "label` writes (default: STORE/labels.csv)");
            app.add_option("--fade", flags->fade,
                           "seconds that going over from one piece of a node to another takes at "
                           "most (default: 0.4 of primitives, as long as both last of bundles)");
            app.add_option(
                   "--registration", flags->registration,
                   "warp: what is alike is blended, as dynamic time warping finds it; even: "
                   "equal shares of time are")
                ->capture_default_str();
            app.add_option("--blend", flags->blend,
                           "label, cluster or bundle: instead of a walk, its motions all at once");
            app.add_option(
                   "--weights", flags->weights,
                   "W,W,… of these motions, one each, in the order of `kinetome export`; they are "
                   "divided by their sum (default: all alike)")
                ->delimiter(',');
            app.add_option(
                "--body", options.body,
                "clip whose skeleton moves (default: the first of the walk, the heaviest of a "
                "blend)");
            app.add_option("--generation", flags->generation,
                           "id, the beginning of one, or current");
            return [=](const Invocation& invocation) { return walk(*flags, invocation); };
        }};
}

}  // namespace kinetome::cli
