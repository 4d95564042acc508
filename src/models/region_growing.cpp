#include "region_growing.h"

#include <algorithm>

#include "frame_count.h"
#include "kinetome/models/graph_paths.h"

namespace kinetome {
namespace {

/// Where repetitive patterns end in a series of frames, each described by the last frame before it
/// that it is similar to (-1: none). A region grows freely until it has met its first pair.
std::vector<int64_t> region_ends(const std::vector<int64_t>& similar_before, int64_t patience) {
    const auto frames = static_cast<int64_t>(similar_before.size());
    std::vector<int64_t> ends;
    int64_t first = 0, last = -1;  // of the region; `last` with a pair inside it
    for (int64_t frame = 0; frame < frames; ++frame) {
        if (similar_before[static_cast<size_t>(frame)] >= first) {
            last = frame;
        } else if (last >= 0 && frame - last >= patience) {
            first = last + 1;
            last = -1;
            ends.push_back(first);
            frame = first;  // whose pairs in its own region are none yet
        }
    }
    if (last >= 0 && last + 1 < frames) ends.push_back(last + 1);
    return ends;
}

struct SimilarFrames {
    std::vector<int64_t> before;  ///< the last one before each frame; -1: none
    std::vector<int64_t> after;   ///< the same of the take run backwards
};

SimilarFrames similar_frames(const NeighborGraph& graph) {
    const NeighborGraph similar = symmetrised(graph);
    const int64_t frames = similar.frames();
    SimilarFrames result{std::vector<int64_t>(size_t(frames), -1),
                         std::vector<int64_t>(size_t(frames), -1)};
    for (int64_t i = 0; i < frames; ++i) {
        const auto neighbours = similar.neighbours(i);
        const auto here = std::ranges::lower_bound(neighbours, i);
        if (here != neighbours.begin()) result.before[size_t(i)] = *(here - 1);
        const auto next = std::ranges::upper_bound(neighbours, i);
        if (next != neighbours.end()) result.after[size_t(frames - 1 - i)] = frames - 1 - *next;
    }
    return result;
}

/// A boundary that the forward pass (an end), the backward pass (a start) or both have set.
struct Cut {
    int64_t frame = 0;
    bool ends = false;
    bool starts = false;
};

std::vector<Cut> all_cuts(const NeighborGraph& graph, int64_t patience) {
    const SimilarFrames similar = similar_frames(graph);
    std::vector<Cut> cuts{{0, false, true}, {graph.frames(), true, false}};
    for (const int64_t end : region_ends(similar.before, patience)) {
        cuts.push_back({end, true, false});
    }
    for (const int64_t end : region_ends(similar.after, patience)) {
        cuts.push_back({graph.frames() - end, false, true});
    }
    std::ranges::stable_sort(cuts, {}, &Cut::frame);
    return cuts;
}

bool between_regions(const Cut& left, const Cut& right) {
    return left.ends && !left.starts && right.starts && !right.ends;
}

/// Cuts too near to each other become one, those of the take's first and last frame staying.
std::vector<Cut> merged(const std::vector<Cut>& cuts, int64_t spacing, int64_t transition) {
    const int64_t take_end = cuts.back().frame;
    std::vector<Cut> kept{cuts.front()};
    for (size_t i = 1; i < cuts.size(); ++i) {
        const Cut& cut = cuts[i];
        Cut& last = kept.back();
        const int64_t least = between_regions(last, cut) ? transition : spacing;
        const bool spans_take = last.frame == 0 && cut.frame == take_end;
        if (spans_take || cut.frame - last.frame >= least) {
            kept.push_back(cut);
            continue;
        }
        if (last.frame > 0) {
            last.frame = cut.frame == take_end ? take_end : (last.frame + cut.frame) / 2;
        }
        last.ends |= cut.ends;
        last.starts |= cut.starts;
    }
    return kept;
}

}  // namespace

std::vector<Segment> grown_regions(const NeighborGraph& graph, const RegionGrowingOptions& options,
                                   double rate, int64_t longest_transition) {
    const std::vector<Cut> cuts =
        merged(all_cuts(without_main_component(graph), frame_count(options.patience, rate)),
               frame_count(options.least_spacing, rate), frame_count(options.least_gap, rate));
    std::vector<Segment> segments;
    int32_t activities = 0;
    for (size_t i = 0; i + 1 < cuts.size(); ++i) {
        Segment& segment = segments.emplace_back();
        segment.frames = {cuts[i].frame, cuts[i + 1].frame};
        if (between_regions(cuts[i], cuts[i + 1]) && segment.frames.size() < longest_transition) {
            segment.kind = SegmentKind::transition;
        } else {
            segment.cluster = activities++;
        }
    }
    return segments;
}

}  // namespace kinetome
