// Labels transferred between annotated takes of the CMU collection, beside those of the nearest
// primitive by plain dynamic time warping.
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "kinetome/base/file.h"
#include "kinetome/features/effectors.h"
#include "kinetome/formats/annotation.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/resample.h"
#include "kinetome/math/warp.h"
#include "kinetome/models/activity.h"
#include "kinetome/models/label_table.h"
#include "kinetome/models/movement_rows.h"
#include "kinetome/models/primitive.h"
#include "support/cmu_take.h"
#include "support/test_corpus.h"

using namespace kinetome;

namespace {

const std::vector<std::string> takes{"13_29", "13_30", "13_31", "14_14"};

struct AnnotatedPrimitives {
    MatrixF poses;
    std::vector<CorpusPrimitive> primitives;
    std::vector<int32_t> labels;
};

/// The activity that holds most of the primitive, whose frames are at 30 Hz.
std::string label_of(const std::vector<TruthRow>& truth, const std::string& take,
                     const RowRange& frames) {
    std::map<std::string, int64_t> covered;
    for (const TruthRow& row : truth) {
        if (row.clip != take) continue;
        covered[row.label] += std::max<int64_t>(
            0, std::min(row.end, 4 * frames.end) - std::max(row.first, 4 * frames.first));
    }
    return std::ranges::max_element(covered, {}, [](const auto& one) { return one.second; })->first;
}

AnnotatedPrimitives annotated_primitives(const std::filesystem::path& corpus) {
    const std::string file = (corpus / "labels" / "truth.csv").string();
    const std::vector<TruthRow> truth = parse_truth_csv(read_source_file(file), file);
    AnnotatedPrimitives all;
    std::map<std::string, int32_t> numbers;
    for (size_t take = 0; take < takes.size(); ++take) {
        const Clip clip = resample(cmu_take(corpus, takes[take]), 30);
        const MatrixF poses = stack_neighbours(
            effector_positions(*clip.skeleton, clip.motion, joint_positions(clip)));
        const NeighborGraph graph = neighbor_graph(poses, KnnOptions{}, KnnEngine::blocks, 2);
        const int64_t row = all.poses.rows();
        for (const Primitive& primitive :
             find_primitives(poses, graph, find_activities(graph, poses, {}), {})) {
            const RowRange& frames = primitive.frames;
            const std::string label = label_of(truth, takes[take], frames);
            all.primitives.push_back({int64_t(take), {row + frames.first, row + frames.end}});
            all.labels.push_back(
                numbers.emplace(label, static_cast<int32_t>(numbers.size())).first->second);
        }
        all.poses.conservativeResize(row + poses.rows(), poses.cols());
        all.poses.bottomRows(poses.rows()) = poses;
    }
    return all;
}

/// Each take by the others.
LabelCounts transferred(const AnnotatedPrimitives& all, const LabelTransferOptions& options) {
    const MatrixF movements = movement_rows(all.poses, all.primitives);
    std::vector<int32_t> truth, given;
    for (int64_t take = 0; take < int64_t(takes.size()); ++take) {
        std::vector<int32_t> known = all.labels;
        std::vector<CorpusPrimitive> asked;
        for (size_t p = 0; p < known.size(); ++p) {
            if (all.primitives[p].clip != take) continue;
            asked.push_back(all.primitives[p]);
            truth.push_back(all.labels[p]);
            known[p] = -1;
        }
        const KnowledgeBase base(movements, all.primitives, known);
        for (const LabelGuess& guess : transfer_labels(base, movements, asked, options, 2)) {
            given.push_back(guess.label);
        }
    }
    return label_table(truth, given, 1 + *std::ranges::max_element(all.labels)).all;
}

/// The highest recall of trusting the nearest primitive of another take up to some distance, at
/// this precision at least.
double recall_of_nearest(const AnnotatedPrimitives& all, double precision) {
    const auto rows = [&](size_t p) {
        const RowRange& range = all.primitives[p].rows;
        return all.poses.middleRows(range.first, range.size());
    };
    std::vector<std::pair<double, bool>> nearest;
    for (size_t a = 0; a < all.labels.size(); ++a) {
        nearest.emplace_back(std::numeric_limits<double>::infinity(), false);
        for (size_t b = 0; b < all.labels.size(); ++b) {
            if (all.primitives[b].clip == all.primitives[a].clip) continue;
            const double cost = warp(rows(a), rows(b), {unlimited_steps(), WarpWeight::cells}).mean;
            if (cost < nearest.back().first)
                nearest.back() = {cost, all.labels[a] == all.labels[b]};
        }
    }
    std::ranges::sort(nearest);
    double best = 0, right = 0;
    for (size_t i = 0; i < nearest.size(); ++i) {
        right += nearest[i].second;
        if (right >= precision * double(i + 1)) best = right / double(nearest.size());
    }
    return best;
}

}  // namespace

TEST_CASE("labels of annotated takes are hardly ever wrong, and more than the nearest would give") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    const AnnotatedPrimitives all = annotated_primitives(*corpus);
    LabelTransferOptions all_labelled;
    all_labelled.recognised = 0.95;
    for (const LabelTransferOptions& options : {LabelTransferOptions{}, all_labelled}) {
        const LabelCounts counts = transferred(all, options);
        CAPTURE(counts.found, counts.correct, counts.missed);
        CHECK(counts.precision() >= 0.95);
        CHECK(counts.recall() >= recall_of_nearest(all, counts.precision()));
    }
    CHECK(transferred(all, all_labelled).recall() >= recall_of_nearest(all, 0.95));
}
