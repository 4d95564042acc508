#include "kinetome/models/signature_index.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

constexpr int32_t leaf_count = 60;

/// Of means spread over half a metre.
MatrixF random_positions() {
    RandomStream random(4, "leaves");
    MatrixF positions(leaf_count, 12);
    for (Eigen::Index i = 0; i < positions.size(); ++i) {
        positions.data()[i] = float(250 * random.uniform());
    }
    return positions;
}

/// Runs and all their frames, which lie where their leaves do.
PlacedSignature at_leaves(const Signature& signature, const MatrixF& positions) {
    std::vector<int32_t> leaves, frame_leaves;
    for (const SignatureRun& run : signature) {
        leaves.push_back(run.leaf);
        frame_leaves.insert(frame_leaves.end(), static_cast<size_t>(run.frames), run.leaf);
    }
    return {signature, positions(leaves, Eigen::all), 1, positions(frame_leaves, Eigen::all)};
}
std::vector<PlacedSignature> at_leaves(const std::vector<Signature>& clips,
                                       const MatrixF& positions) {
    std::vector<PlacedSignature> placed;
    for (const Signature& clip : clips) placed.push_back(at_leaves(clip, positions));
    return placed;
}

/// Clips that walk at random among the leaves nearest to each other.
std::vector<Signature> random_clips(int64_t count, const MatrixF& positions) {
    std::vector<Signature> clips;
    for (int64_t clip = 0; clip < count; ++clip) {
        RandomStream random(7, "clip", static_cast<uint64_t>(clip));
        std::vector<int32_t> leaves;
        const auto frames = 300 + random.below(1500);
        auto leaf = static_cast<int32_t>(random.below(leaf_count));
        while (leaves.size() < frames) {
            leaves.insert(leaves.end(), 1 + random.below(25), leaf);
            const VectorF near = (positions.rowwise() - positions.row(leaf)).rowwise().norm();
            const auto other = static_cast<int32_t>(random.below(leaf_count));
            if (other != leaf && near[other] < near.mean()) leaf = other;
        }
        leaves.resize(frames);
        clips.push_back(make_signature(leaves));
    }
    return clips;
}

struct Example {
    MatrixF positions = random_positions();
    std::vector<Signature> clips = random_clips(40, positions);
    SignatureIndex index{at_leaves(clips, positions), positions, {}, 1};

    std::vector<IndexedMatch> search(const Signature& query, int64_t k,
                                     const SignatureSearchOptions& options) const {
        return index.search(at_leaves(query, positions), k, options);
    }
};

/// Every `1 / factor`-th frame of some of a clip.
Signature at_tempo(const Signature& clip, const RowRange& frames, double factor) {
    std::vector<int32_t> leaves;
    const auto count = static_cast<int64_t>(double(frames.size()) * factor);
    for (int64_t i = 0; i < count; ++i) {
        const auto frame = frames.first + static_cast<int64_t>(double(i) / factor);
        leaves.push_back(clip[static_cast<size_t>(run_at(clip, frame))].leaf);
    }
    return make_signature(leaves);
}

/// The nearest match anywhere, without an index, frame by frame.
SignatureMatch nearest_by_scan(const Example& example, const Signature& query,
                               const SignatureMatchOptions& options) {
    const MatrixF asked = at_leaves(query, example.positions).sample_positions;
    SignatureMatch nearest{{}, std::numeric_limits<double>::infinity()};
    for (const Signature& clip : example.clips) {
        const MatrixF text = at_leaves(clip, example.positions).sample_positions;
        MatrixF distances(asked.rows(), text.rows());
        for (Eigen::Index i = 0; i < asked.rows(); ++i) {
            distances.row(i) = (text.rowwise() - asked.row(i)).rowwise().norm().transpose();
        }
        const auto matches = match_paces(asked.rows(), distances, options);
        if (!matches.empty()) nearest = std::min(nearest, matches.front());
    }
    return nearest;
}

/// Poses (cm) that sway by some centimetres, never twice in the same way.
MatrixF swaying_poses(uint64_t seed, int64_t frames, double speed) {
    RandomStream random(seed, "sway");
    MatrixF poses = MatrixF::Zero(frames, 9);
    for (Eigen::Index j = 3; j < poses.cols(); ++j) {
        const double pace = speed * (0.5 + random.uniform()), phase = 6 * random.uniform();
        for (Eigen::Index i = 0; i < frames; ++i) {
            poses(i, j) = float(4 * std::sin(pace * double(i) + phase));
        }
    }
    return poses;
}

}  // namespace

TEST_CASE("a query is answered by what lies nearest to it, though in the same leaf") {
    const Signature runs{{0, 0, 40}};
    std::vector<PlacedSignature> clips;
    for (const float at : {0.0F, 10.0F, -10.0F}) {
        clips.push_back({runs, MatrixF::Constant(1, 1, at), 40, MatrixF::Constant(2, 1, at)});
    }
    const SignatureIndex index(clips, MatrixF::Zero(1, 1), {}, 1);
    const auto found =
        index.search({runs, MatrixF::Constant(1, 1, -6), 40, MatrixF::Constant(2, 1, -6)}, 3, {});
    REQUIRE(found.size() == 3);
    CHECK(found[0].clip == 2);
    CHECK(found[0].match.distance == Approx(4));
    CHECK(found[1].clip == 0);
    CHECK(found[2].match.distance == Approx(16));
}

TEST_CASE("a part of a motion in one long run finds itself, to the frame") {
    const MatrixF axes = MatrixF::Identity(9, 9), leaf = MatrixF::Zero(1, 9);
    for (const double speed : {0.003, 0.05}) {  // standing, running
        std::vector<PlacedSignature> clips;
        std::vector<MatrixF> poses;
        for (uint64_t seed = 0; seed < 4; ++seed) {
            poses.push_back(swaying_poses(seed, 700, speed));
            clips.push_back(place_signature({{0, 0, 700}}, poses.back(), axes, 8));
        }
        const SignatureIndex index(clips, leaf, {}, 1);
        for (const RowRange frames : {RowRange{100, 340}, {103, 344}, {0, 61}, {459, 700}}) {
            const PlacedSignature query =
                place_signature({{0, 0, int32_t(frames.size())}},
                                poses[2].middleRows(frames.first, frames.size()), axes, 1);
            for (const int64_t k : {1, 10}) {
                const auto found = index.search(query, k, {});
                INFO("speed " << speed << ", frames " << frames.first << " to " << frames.end);
                REQUIRE_FALSE(found.empty());
                INFO("found " << found[0].match.frames.first << " to "
                              << found[0].match.frames.end);
                CHECK(found[0].clip == 2);
                CHECK(found[0].match.frames == frames);
                CHECK(found[0].match.distance < 0.5);
            }
        }
    }
}

TEST_CASE("a tolerance holds of where an answer is moved to, not of the step it was found at") {
    const MatrixF axes = MatrixF::Identity(9, 9);
    const MatrixF poses = swaying_poses(3, 700, 0.05);
    const SignatureIndex index({place_signature({{0, 0, 700}}, poses, axes, 8)},
                               MatrixF::Zero(1, 9), {}, 1);
    SignatureSearchOptions options;
    options.match.tolerance = 0.5;
    const auto found = index.search(
        place_signature({{0, 0, 240}}, poses.middleRows(101, 240), axes, 1), 10, options);
    REQUIRE(found.size() == 1);
    CHECK(found[0].match.frames == RowRange{101, 341});
}

TEST_CASE("positions that do not fit their runs or samples are refused") {
    const Signature runs{{0, 0, 40}};
    const MatrixF leaf = MatrixF::Zero(1, 3), ends = MatrixF::Zero(2, 3);
    const auto index_of = [&](const std::vector<PlacedSignature>& clips) {
        return SignatureIndex(clips, leaf, {}, 1);
    };
    const PlacedSignature right{runs, leaf, 40, ends};
    CHECK_THROWS_AS(index_of({{runs, ends, 40, ends}}), std::invalid_argument);
    CHECK_THROWS_AS(index_of({{runs, leaf, 40, leaf}}), std::invalid_argument);
    CHECK_THROWS_AS(index_of({right, {runs, leaf, 39, ends}}), std::invalid_argument);
    CHECK(index_of({{}, right, {}}).parts().stride == 40);  // clips without frames have none
    const SignatureIndex index = index_of({right});
    CHECK_THROWS_AS(index.search({runs, MatrixF::Zero(1, 2), 40, ends}, 1, {}),
                    std::invalid_argument);
    CHECK_THROWS_AS(index.search({runs, ends, 40, ends}, 1, {}), std::invalid_argument);
    CHECK_THROWS_AS(index.search({runs, leaf, 40, MatrixF::Zero(3, 3)}, 1, {}),
                    std::invalid_argument);
    for (MatrixF SignatureIndex::Parts::*positions :
         {&SignatureIndex::Parts::positions, &SignatureIndex::Parts::sample_positions}) {
        auto parts = index.parts();
        parts.*positions = MatrixF::Zero(3, 3);
        CHECK_THROWS_AS(SignatureIndex(parts), std::invalid_argument);
        parts = index.parts();
        (parts.*positions)(0, 1) = std::numeric_limits<float>::quiet_NaN();
        CHECK_THROWS_AS(SignatureIndex(parts), std::invalid_argument);
    }
}

TEST_CASE("the index finds what a scan of all signatures finds nearest") {
    const Example example;
    SignatureSearchOptions options;
    options.match.step = 1;
    for (int64_t clip = 0; clip < 40; clip += 3) {
        const Signature query = at_tempo(example.clips[size_t(clip)], {40, 280}, 1.2);
        const auto found = example.search(query, 5, options);
        REQUIRE(found.size() == 5);
        const auto expected = nearest_by_scan(example, query, options.match);
        CHECK(found.front().match.distance == Approx(expected.distance).margin(1e-3));
        CHECK(found.front().clip == clip);
    }
}

TEST_CASE("a part of a clip at any tempo finds the clip first") {
    const Example example;
    for (const MatchRule rule : {MatchRule::pace, MatchRule::repeats, MatchRule::edit}) {
        for (const double factor : {0.7, 1.0, 1.4}) {
            for (int64_t clip = 0; clip < 40; clip += 5) {
                SignatureSearchOptions options;
                options.match.rule = rule;
                const Signature& whole = example.clips[size_t(clip)];
                const auto some = example.search(at_tempo(whole, {20, 240}, factor), 1, options);
                const RowRange all{0, frame_count(whole)};
                const auto full = example.search(at_tempo(whole, all, factor), 1, options);
                REQUIRE(some.size() == 1);
                REQUIRE(full.size() == 1);
                CHECK(some.front().clip == clip);
                CHECK(full.front().clip == clip);
            }
        }
    }
}

TEST_CASE("answers come nearest first and at different places") {
    const Example example;
    const Signature query = part_of(example.clips[3], {100, 220});
    const SignatureSearchOptions options;
    const auto found = example.search(query, 20, options);
    REQUIRE(found.size() == 20);
    for (size_t i = 0; i < found.size(); ++i) {
        const RowRange& frames = found[i].match.frames;
        CHECK(frames.first >= 0);
        CHECK(frames.end <= frame_count(example.clips[size_t(found[i].clip)]));
        for (size_t j = 0; j < i; ++j) {
            CHECK(found[j].match.distance <= found[i].match.distance);
            CHECK_FALSE((found[j].clip == found[i].clip &&
                         is_same_place(found[j].match.frames, frames, options.match.overlap)));
        }
    }
    CHECK(std::ranges::equal(example.search(query, 7, options), std::span(found).first(7)));
}

TEST_CASE("exact matches are all of those there are") {
    const Example example;
    SignatureSearchOptions options;
    options.match.tolerance = 0;
    for (const int64_t runs : {1, 2, 3}) {
        const auto whole = std::span(example.clips[5]);
        Signature query(whole.begin() + 4, whole.begin() + 4 + runs);
        const int32_t start = query.front().first_frame;
        for (SignatureRun& run : query) run.first_frame -= start;
        size_t expected = 0;
        for (const Signature& clip : example.clips) expected += exact_matches(query, clip).size();
        options.match.overlap = 1;
        const auto found = example.search(query, 1000000, options);
        CHECK(found.size() == expected);
        CHECK(std::ranges::all_of(found, [](const auto& one) { return one.match.distance == 0; }));
    }
}

TEST_CASE("an index is the same for any number of threads, and out of its parts") {
    const Example example;
    const SignatureIndex threaded(at_leaves(example.clips, example.positions), example.positions,
                                  {}, 3);
    const auto& expected = example.index.parts();
    CHECK(threaded.parts().near_leaves.values == expected.near_leaves.values);
    CHECK(threaded.parts().occurrences.values == expected.occurrences.values);
    const SignatureIndex again(expected);
    const Signature query = part_of(example.clips[9], {10, 190});
    CHECK(again.search(at_leaves(query, example.positions), 10, {}) ==
          example.search(query, 10, {}));
}

TEST_CASE("parts that do not fit make no index") {
    const Example example;
    auto parts = example.index.parts();
    parts.clips.values.front().leaf = leaf_count;
    CHECK_THROWS_AS(SignatureIndex(parts), std::invalid_argument);
    parts = example.index.parts();
    parts.occurrences.values.front() = static_cast<int32_t>(parts.clips.values.size());
    CHECK_THROWS_AS(SignatureIndex(parts), std::invalid_argument);
    parts = example.index.parts();
    parts.near_leaves.first.pop_back();
    CHECK_THROWS_AS(SignatureIndex(parts), std::invalid_argument);
    const PlacedSignature unknown{
        {{leaf_count, 0, 4}}, example.positions.topRows(1), 4, example.positions.topRows(2)};
    CHECK_THROWS_AS(SignatureIndex({unknown}, example.positions, {}, 1), std::invalid_argument);
}

TEST_CASE("an empty index and an empty query have no answers") {
    const MatrixF positions = random_positions();
    const PlacedSignature query = at_leaves(Signature{{3, 0, 40}}, positions);
    CHECK(SignatureIndex(std::vector<PlacedSignature>(), positions, {}, 1)
              .search(query, 10, {})
              .empty());
    CHECK(Example().index.search({}, 10, {}).empty());
    const PlacedSignature frame = at_leaves(Signature{{3, 0, 1}}, positions);
    const SignatureIndex short_clips({frame, {}}, positions, {}, 1);
    CHECK(short_clips.search(frame, 10, {}).size() == 1);
}
