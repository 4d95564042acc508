#include "kinetome/stages/node_blend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/formats/kinematics.h"
#include "walk_clips.h"

namespace kinetome {

std::vector<ClipPrimitive> motions_of_node(const std::vector<ClipPrimitive>& primitives,
                                           const std::string& name, const GraphStyle& style,
                                           const std::string& option) {
    std::vector<ClipPrimitive> motions;
    std::set<int32_t> clusters;
    for (const ClipPrimitive& one : primitives) {
        if (one.cluster < 0) continue;
        if (one.label != name && std::to_string(one.cluster) != name) continue;
        motions.push_back(one);
        clusters.insert(one.cluster);
    }
    if (motions.empty()) {
        throw UsageError(fmt::format("{} {}: no {} has this label or number; {}", option,
                                     quote_for_message(name), style.group, style.listing));
    }
    if (clusters.size() > 1) {
        throw UsageError(fmt::format("{} {}: that are {}s {}; name one of them", option,
                                     quote_for_message(name), style.group,
                                     fmt::join(clusters, ", ")));
    }
    return motions;
}

namespace {

/// One for each motion, which add up to 1.
std::vector<double> weights_of(const BlendOptions& options, size_t motions) {
    std::vector<double> weights = options.weights;
    if (weights.empty()) weights.assign(motions, 1);
    if (weights.size() != motions) {
        throw UsageError(fmt::format(
            "--weights: {} given for the {} motions of {} {}: expected one "
            "each, 0 for what is left out",
            weights.size(), motions, options.style.group, quote_for_message(options.node)));
    }
    for (const double weight : weights) {
        if (!(weight >= 0) || !std::isfinite(weight)) {
            throw UsageError(fmt::format("--weights: {} is no weight, 0 or more", weight));
        }
    }
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(total > 0)) throw UsageError("--weights: one of them must be above 0");
    for (double& weight : weights) weight /= total;
    return weights;
}

Clip cut(const Clip& clip, const MotionPiece& piece) {
    const int64_t end = std::min(piece.end, clip.frames());
    return {clip.skeleton, clip.motion.middleRows(piece.first, end - piece.first), clip.rate};
}

JointPeaks peaks_of(const Clip& clip) {
    return joint_peaks(joint_positions(clip), clip.rate);
}

double largest_pose_step(const Clip& clip) {
    const auto steps = pose_steps(clip);
    return steps.empty() ? 0 : std::ranges::max(steps);
}

}  // namespace

NodeBlend blend_node(const std::vector<ClipPrimitive>& primitives, const ClipSource& source,
                     const BlendOptions& options) {
    NodeBlend blend;
    blend.parts = motions_of_node(primitives, options.node, options.style, "--blend");
    blend.weights = weights_of(options, blend.parts.size());
    const auto heaviest =
        static_cast<int32_t>(std::ranges::max_element(blend.weights) - blend.weights.begin());
    blend.body =
        options.body.empty() ? blend.parts[static_cast<size_t>(heaviest)].clip : options.body;

    const StoredGraph graph = stored_graph(blend.parts, source, 0, options.style);
    const WalkOptions walk{.registered = options.registered, .style = options.style};
    WalkClips clips(graph, source, walk, blend.body);
    std::vector<BlendPart> parts;
    for (size_t i = 0; i < blend.parts.size(); ++i) {
        const auto piece = static_cast<int32_t>(i);
        if (blend.weights[i] == 0) continue;
        parts.push_back(clips.part(piece, heaviest, blend.weights[i]));
        const Clip part = cut(*parts.back().clip, graph.nodes.graph.piece(piece));
        blend.peaks_of_parts = larger(blend.peaks_of_parts, peaks_of(part));
        blend.pose_step_of_parts = std::max(blend.pose_step_of_parts, largest_pose_step(part));
    }
    blend.motion = blend_motions(parts);
    blend.node = graph.nodes.name_of(0);
    blend.peaks = peaks_of(blend.motion);
    blend.pose_step = largest_pose_step(blend.motion);
    return blend;
}

}  // namespace kinetome
