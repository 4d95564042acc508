#include "kinetome/models/match_rerank.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace kinetome;

namespace {

/// A clip whose one feature swings ever faster, so that it is nowhere like elsewhere.
MatrixF chirp(int64_t frames, double speed) {
    MatrixF rows(frames, 2);
    for (int64_t i = 0; i < frames; ++i) {
        const double t = double(i) / 300;
        rows(i, 0) = float(100 * std::sin(speed * t * t * t));
        rows(i, 1) = float(50 * t);
    }
    return rows;
}

struct Clips {
    std::vector<MatrixF> rows{chirp(600, 9), chirp(600, 14)};
    std::vector<int64_t> frames{600, 600};

    std::vector<IndexedMatch> rerank(const MatrixF& query, const std::vector<IndexedMatch>& matches,
                                     int threads = 1) const {
        return rerank_matches(
            query, matches, frames, 10,
            [&](int32_t clip, const RowRange& some) -> MatrixF {
                return rows[size_t(clip)].middleRows(some.first, some.size());
            },
            {}, threads);
    }
};

}  // namespace

TEST_CASE("the motion that is the same comes first, where it is") {
    const Clips clips;
    const MatrixF query = clips.rows[1].middleRows(400, 120);
    // Found with the other one nearer, and some frames off.
    const auto found = clips.rerank(query, {{0, {{400, 520}, 1}}, {1, {{381, 510}, 2}}});
    REQUIRE(found.size() == 2);
    CHECK(found[0].clip == 1);
    CHECK(found[0].match == SignatureMatch{{400, 520}, 0});
    CHECK(found[1].match.distance > 1);
}

TEST_CASE("two matches that move to one place become one") {
    const Clips clips;
    const MatrixF query = clips.rows[0].middleRows(200, 120);
    const auto found = clips.rerank(query, {{0, {{183, 310}, 1}}, {0, {{211, 330}, 2}}}, 2);
    REQUIRE(found.size() == 1);
    CHECK(found[0].match == SignatureMatch{{200, 320}, 0});
}

TEST_CASE("a motion that is no whole number of strides is found to the frame") {
    const Clips clips;
    for (const int64_t frames : {117, 118, 119, 121}) {
        const MatrixF query = clips.rows[1].middleRows(401, frames);
        const auto found = clips.rerank(query, {{1, {{392, 528}, 1}}});
        REQUIRE(found.size() == 1);
        CHECK(found[0].match == SignatureMatch{{401, 401 + frames}, 0});
    }
}

TEST_CASE("matches at the ends of a clip stay inside it") {
    const Clips clips;
    const MatrixF query = clips.rows[0].middleRows(480, 118);
    const auto found = clips.rerank(query, {{0, {{490, 600}, 1}}, {0, {{0, 70}, 2}}});
    REQUIRE_FALSE(found.empty());
    for (const IndexedMatch& one : found) {
        CHECK(one.match.frames.first >= 0);
        CHECK(one.match.frames.end <= 600);
    }
    CHECK(clips.rerank(query, {}).empty());
}
