#include "kinetome/stages/segment_file.h"

#include <catch2/catch.hpp>

using namespace kinetome;

namespace {

/// 12 frames at 30 frames a second, made of 4 at 10.
CutClip slow_clip() {
    return {"slow", "class", 12, 4, 10};
}

}  // namespace

TEST_CASE("what lies between two frames of a slow source is in none of its tables") {
    SegmentedClip segmented{slow_clip(), {}};
    PrimitiveClip primitives{slow_clip(), {}};
    for (const RowRange& frames : {RowRange{0, 1}, {1, 3}, {3, 7}, {7, 9}, {9, 12}}) {
        const auto number = static_cast<int32_t>(segmented.segments.size());
        segmented.segments.push_back({frames, SegmentKind::activity, number});
        primitives.primitives.push_back({{frames, number}, number, number});
    }
    const std::vector<RowRange> expected{{0, 1}, {1, 3}, {3, 4}};
    const std::vector<int32_t> numbers{0, 2, 4};

    const auto segments = in_source({segmented}, 30).front().segments;
    const auto kept = in_source({primitives}, 30).front().primitives;
    REQUIRE(segments.size() == expected.size());
    REQUIRE(kept.size() == expected.size());
    for (size_t i = 0; i < expected.size(); ++i) {
        CHECK(segments[i].frames == expected[i]);
        CHECK(segments[i].cluster == numbers[i]);
        CHECK(kept[i].primitive.frames == expected[i]);
        CHECK(kept[i].primitive.activity == numbers[i]);
    }
}
