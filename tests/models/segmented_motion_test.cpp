// Activities and primitives of whole takes: generated ones, whose truth is known, and annotated
// ones of the CMU collection.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "kinetome/base/file.h"
#include "kinetome/features/effectors.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/resample.h"
#include "kinetome/models/activity.h"
#include "kinetome/models/primitive.h"
#include "kinetome/models/segmentation_score.h"
#include "kinetome/synthesis/corpus_generator.h"
#include "kinetome/synthesis/take.h"
#include "support/cmu_take.h"
#include "support/test_corpus.h"

using namespace kinetome;

namespace {

constexpr double rate = 30;

struct SegmentedTake {
    int64_t frames = 0;  ///< at 120 Hz, as all frames here
    std::vector<Segment> segments;
    std::vector<RowRange> primitives;
};

SegmentedTake segmented(const Clip& take, const ActivityOptions& options = {}) {
    const Clip clip = resample(take, rate);
    const MatrixF features =
        stack_neighbours(effector_positions(*clip.skeleton, clip.motion, joint_positions(clip)));
    const NeighborGraph graph = neighbor_graph(features, {}, KnnEngine::blocks, 1);
    const auto at_120 = [&](const RowRange& frames) {
        return RowRange{4 * frames.first, std::min(4 * frames.end, take.frames())};
    };
    SegmentedTake result{take.frames(), find_activities(graph, features, options), {}};
    for (const Primitive& primitive : find_primitives(features, graph, result.segments))
        result.primitives.push_back(at_120(primitive.frames));
    for (Segment& segment : result.segments) segment.frames = at_120(segment.frames);
    return result;
}

struct GeneratedTake {
    Annotations truth;
    SegmentedTake found;
};

/// Forty takes of half a minute, four a performer: made once for all tests.
const std::vector<GeneratedTake>& generated_takes() {
    static const std::vector<GeneratedTake> takes = [] {
        constexpr uint64_t seed = 33;
        std::vector<GeneratedTake> made;
        for (int64_t index = 0; index < 40; ++index) {
            const int64_t subject = 1 + index / 4;
            const TakePlan plan = plan_take(index, 3600, subject, 1 + index % 4, seed);
            made.push_back(
                {annotate(plan), segmented(perform(plan, make_subject(subject, seed), seed))});
        }
        return made;
    }();
    return takes;
}

int64_t middle(const RowRange& frames) {
    return (frames.first + frames.end) / 2;
}

/// The primitives whose middle lies in an activity.
int64_t count_within(const std::vector<RowRange>& primitives, const TruthRow& activity) {
    return std::ranges::count_if(primitives, [&](const RowRange& frames) {
        return middle(frames) >= activity.first && middle(frames) < activity.end;
    });
}

SegmentationScore score_of_takes(const std::filesystem::path& corpus,
                                 const std::vector<std::string>& names,
                                 const ActivityOptions& options) {
    const std::string file = (corpus / "labels" / "truth.csv").string();
    const std::vector<TruthRow> rows = parse_truth_csv(read_source_file(file), file);
    std::vector<SegmentationScore> scores;
    for (const std::string& name : names) {
        std::vector<TruthRow> of_take;
        std::ranges::copy_if(rows, std::back_inserter(of_take),
                             [&](const TruthRow& row) { return row.clip == name; });
        const SegmentedTake take = segmented(cmu_take(corpus, name), options);
        scores.push_back(
            score_segments(truth_timeline(of_take, take.frames, 120, file), take.segments));
    }
    return average(scores);
}

}  // namespace

TEST_CASE("the boundaries of generated activities are found to a third of a second") {
    std::vector<SegmentationScore> scores;
    double found = 0, boundaries = 0;
    for (const GeneratedTake& take : generated_takes()) {
        const auto truth =
            truth_timeline(take.truth.truth, take.found.frames, synthesis_rate, "truth.csv");
        const auto zones = double(truth.zones.size());
        const SegmentationScore score = score_segments(
            truth, take.found.segments, {.rate = synthesis_rate, .boundary_tolerance = 10 / rate});
        found += score.boundary_recall * zones;
        boundaries += zones;
    }
    REQUIRE(boundaries > 80);
    CAPTURE(found, boundaries);
    CHECK(found >= 0.95 * boundaries);
}

TEST_CASE("the cycles of generated activities are counted") {
    int64_t activities = 0, exact = 0;
    for (const GeneratedTake& take : generated_takes()) {
        for (const TruthRow& activity : take.truth.truth) {
            const int64_t count =
                std::ranges::count_if(take.truth.cycles, [&](const CycleRow& cycle) {
                    return cycle.first >= activity.first && cycle.end <= activity.end;
                });
            if (count == 0) continue;
            ++activities;
            exact += count_within(take.found.primitives, activity) == count;
        }
    }
    REQUIRE(activities > 80);
    CAPTURE(exact, activities);
    CHECK(double(exact) >= 0.90 * double(activities));
}

TEST_CASE("annotated takes are segmented as well as by the method's reference") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    const SegmentationScore score =
        score_of_takes(*corpus, {"86_01", "13_29", "13_30", "13_31", "14_14"}, {});
    CHECK(score.strict >= 0.85);
    CHECK(score.tolerant >= 0.98);
    CHECK(score.hungarian_without_zones >= 0.92);
    CHECK(score.boundary_precision >= 0.87);
    CHECK(score.boundary_recall >= 0.93);
}

TEST_CASE("region growing segments the paper's take as well as the paper says") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    ActivityOptions options;
    options.method = ActivityMethod::region_growing;
    const SegmentationScore score = score_of_takes(*corpus, {"86_01"}, options);
    CHECK(score.strict >= 0.84);
    CHECK(score.tolerant >= 0.96);
    CHECK(score.counts.activities == 13);  // as the reference: about twice as many as there are
}
