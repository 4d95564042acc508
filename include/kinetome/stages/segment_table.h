// Segments and primitives as other programs may bring them: the tables that `export segments` and
// `export primitives` write (design: CSV contracts).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/base/pieces.h"
#include "kinetome/models/segment.h"

namespace kinetome {

/// A take cut into segments. Frames count at the source's rate.
struct SegmentedTake {
    std::string clip;
    int64_t frames = 0;
    double rate = 0;  ///< frames a second
    std::vector<Segment> segments;
};

/// The primitives of a take. Frames count at the source's rate.
struct PrimitivesOfTake {
    std::string clip;
    std::vector<RowRange> primitives;
    std::vector<int32_t> clusters;  ///< of each, the same in all takes
};

/// clip,first,end,kind,activity_cluster; the cluster of a transition is empty or -1. A take ends
/// with its last segment. Takes by name, segments by frame whatever their order in the file. Throws
/// InputError naming the line: for segments that overlap or leave frames out among others.
std::vector<SegmentedTake> parse_segments_csv(std::string_view text, const std::string& path,
                                              double rate);

/// clip,first,end,activity_first,cluster,label; labels are not kept. Takes by name, primitives by
/// frame. Throws InputError naming the line, also for primitives that overlap.
std::vector<PrimitivesOfTake> parse_primitives_csv(std::string_view text, const std::string& path);

}  // namespace kinetome
