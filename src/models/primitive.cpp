#include "kinetome/models/primitive.h"

#include <stdexcept>

#include "cost_ridges.h"
#include "minor_diagonals.h"

namespace kinetome {
namespace {

void check_input(const MatrixFView& features, const NeighborGraph& graph,
                 std::span<const Segment> segments, const PrimitiveOptions& options) {
    if (features.rows() != graph.frames()) {
        throw std::invalid_argument("primitives: the graph is of another take than the features");
    }
    if (!(options.rate > 0)) throw std::invalid_argument("primitives: the rate is not positive");
    for (const Segment& segment : segments) {
        if (segment.frames.first < 0 || segment.frames.end <= segment.frames.first ||
            segment.frames.end > features.rows()) {
            throw std::invalid_argument("primitives: a segment is empty or lies outside the take");
        }
    }
}

}  // namespace

std::vector<Primitive> find_primitives(const MatrixFView& features, const NeighborGraph& graph,
                                       std::span<const Segment> segments,
                                       const PrimitiveOptions& options) {
    check_input(features, graph, segments, options);
    const bool follows_paths = options.method == PrimitiveMethod::warping_paths;
    const NeighborGraph near =
        follows_paths ? within(graph, options.warping_paths.radius) : NeighborGraph();
    std::vector<Primitive> primitives;
    for (size_t s = 0; s < segments.size(); ++s) {
        if (segments[s].kind != SegmentKind::activity) continue;
        const RowRange& activity = segments[s].frames;
        const std::vector<int64_t> cuts = follows_paths
                                              ? minor_diagonal_cuts(near, activity, options)
                                              : cost_ridge_cuts(features, activity, options);
        for (size_t c = 0; c + 1 < cuts.size(); ++c) {
            primitives.push_back({{cuts[c], cuts[c + 1]}, static_cast<int32_t>(s)});
        }
    }
    return primitives;
}

}  // namespace kinetome
