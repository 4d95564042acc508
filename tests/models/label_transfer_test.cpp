#include "kinetome/models/label_transfer.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>

#include "generated_primitives.h"
#include "kinetome/base/random.h"
#include "kinetome/math/warp.h"
#include "kinetome/models/label_table.h"

using namespace kinetome;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<int32_t> numbers_of(const std::vector<std::string>& labels) {
    std::map<std::string, int32_t> numbers;
    std::vector<int32_t> result;
    for (const std::string& label : labels) {
        result.push_back(
            numbers.emplace(label, static_cast<int32_t>(numbers.size())).first->second);
    }
    return result;
}

/// Cycles of movements 400 apart, in clips of one movement; each clip begins anywhere in a cycle.
struct Cycles {
    MatrixF features;
    std::vector<CorpusPrimitive> primitives;
    std::vector<int32_t> labels;
};

Cycles cycles(int64_t clips, int64_t cycles_each, int32_t kinds) {
    RandomStream random(2, "cycles");
    Cycles all;
    std::vector<std::array<float, 3>> rows;
    for (int64_t clip = 0; clip < clips; ++clip) {
        const auto kind = static_cast<int32_t>(random.below(static_cast<uint64_t>(kinds)));
        double phase = random.uniform(0, 6.28);
        for (int64_t cycle = 0; cycle < cycles_each; ++cycle) {
            const auto first = static_cast<int64_t>(rows.size());
            const auto frames = static_cast<int64_t>(random.uniform(18, 30));
            for (int64_t i = 0; i < frames; ++i, phase += 6.2832 / double(frames)) {
                rows.push_back({float(60 * std::sin(phase) + random.normal()),
                                float(60 * std::cos(phase) + random.normal()),
                                float(400 * kind) + float(random.normal())});
            }
            all.primitives.push_back({clip, {first, first + frames}});
            all.labels.push_back(kind);
        }
    }
    all.features = Eigen::Map<const MatrixF>(rows.front().data(), int64_t(rows.size()), 3);
    return all;
}

LabelGuess guess_one(const MatrixF& known, const std::vector<CorpusPrimitive>& primitives,
                     const std::vector<int32_t>& labels, const MatrixF& asked,
                     const LabelTransferOptions& options = {}) {
    return KnowledgeBase(known, primitives, labels, 1).label_of(asked, options);
}

}  // namespace

TEST_CASE("a label costs what the cheapest match in its runs does") {
    const GeneratedPrimitives all = generated_primitives(20);
    const std::vector<int32_t> labels = numbers_of(all.labels);
    const auto is_known = [&](size_t p) { return all.primitives[p].clip % 2 == 0; };
    std::vector<int32_t> known(labels.size(), -1);
    std::vector<RowRange> runs;
    std::vector<int32_t> run_labels;
    for (size_t p = 0; p < labels.size(); ++p) {
        if (!is_known(p)) continue;
        known[p] = labels[p];
        const RowRange& rows = all.primitives[p].rows;
        if (p > 0 && known[p - 1] == known[p] && adjoin(all.primitives[p - 1], all.primitives[p])) {
            runs.back().end = rows.end;
        } else {
            runs.push_back(rows);
            run_labels.push_back(known[p]);
        }
    }
    const KnowledgeBase base(all.features, all.primitives, known, 1);
    int64_t found = 0, rivals = 0;
    for (size_t p = 0; p < labels.size(); ++p) {
        if (is_known(p)) continue;
        const RowRange& rows = all.primitives[p].rows;
        const auto query = all.features.middleRows(rows.first, rows.size());
        std::map<int32_t, double> costs;
        for (size_t r = 0; r < runs.size(); ++r) {
            const auto run = all.features.middleRows(runs[r].first, runs[r].size());
            for (const WarpPath& path :
                 warp_matches(query, run, {infinite, slope_limited_steps(), 96})) {
                double& cost = costs.emplace(run_labels[r], infinite).first->second;
                cost = std::min(cost, path.mean);
            }
        }
        std::vector<double> ordered{infinite, infinite};
        for (const auto& [label, cost] : costs) ordered.push_back(cost);
        std::ranges::sort(ordered);
        const LabelGuess guess = base.label_of(query, {96, 72, 0, 0.8});
        CHECK(guess.cost == Approx(ordered[0]).epsilon(1e-5));
        CHECK(guess.rival == Approx(ordered[1]).epsilon(1e-5));
        const bool leads = guess.cost <= 72 && guess.cost < 0.8 * guess.rival;
        CHECK((guess.label >= 0) == leads);
        if (leads) CHECK(costs.at(guess.label) == Approx(guess.cost).epsilon(1e-5));
        if (guess.source >= 0 && leads) CHECK(known[size_t(guess.source)] == guess.label);
        found += leads;
        rivals += ordered[1] < infinite;
    }
    CHECK(found > 10);
    CHECK(rivals > 10);
}

TEST_CASE("labels of generated motion are almost never wrong and mostly found") {
    const GeneratedPrimitives all = generated_primitives(80);
    const std::vector<int32_t> labels = numbers_of(all.labels);
    std::vector<int32_t> known(labels.size(), -1), truth, given;
    std::vector<CorpusPrimitive> asked;
    for (size_t p = 0; p < labels.size(); ++p) {
        if (all.primitives[p].clip % 2 == 0) {
            known[p] = labels[p];
        } else {
            asked.push_back(all.primitives[p]);
            truth.push_back(labels[p]);
        }
    }
    const KnowledgeBase base(all.features, all.primitives, known, 2);
    const auto guesses = transfer_labels(base, all.features, asked, {}, 1);
    CHECK(guesses == transfer_labels(base, all.features, asked, {}, 3));
    for (const LabelGuess& guess : guesses) given.push_back(guess.label);
    const LabelCounts counts = label_table(truth, given, 12).all;
    CAPTURE(counts.found, counts.correct, counts.missed);
    CHECK(counts.precision() >= 0.99);
    CHECK(counts.recall() >= 0.8);
}

TEST_CASE("a movement is known from wherever in its cycle it begins") {
    const Cycles all = cycles(12, 4, 3);
    std::vector<int32_t> known(all.labels);
    std::vector<CorpusPrimitive> asked;
    std::vector<int32_t> truth, given;
    for (size_t p = 0; p < known.size(); ++p) {
        if (all.primitives[p].clip < 6) continue;
        known[p] = -1;
        asked.push_back(all.primitives[p]);
        truth.push_back(all.labels[p]);
    }
    const KnowledgeBase base(all.features, all.primitives, known, 1);
    for (const LabelGuess& guess : transfer_labels(base, all.features, asked, {}, 1)) {
        given.push_back(guess.label);
    }
    CHECK(given == truth);
}

TEST_CASE("no label is given where none is near, two are as near, or little of one is met") {
    MatrixF line(40, 2);
    for (int64_t i = 0; i < 40; ++i) line.row(i) << float(10 * i), 0;
    const std::vector<CorpusPrimitive> halves{{0, {0, 20}}, {1, {20, 40}}};
    const MatrixF first = line.topRows(20);

    const LabelGuess sure = guess_one(line, halves, {7, 8}, first);
    CHECK(sure.label == 7);
    CHECK(sure.source == 0);
    CHECK(sure.cost == 0);
    CHECK(guess_one(line, halves, {7, 8}, first.array() + 300.0F).label == -1);
    CHECK(guess_one(line, halves, {7, 8}, line.middleRows(10, 20)).label == -1);

    const std::vector<CorpusPrimitive> twice{{0, {0, 20}}, {1, {0, 20}}};
    const LabelGuess tie = guess_one(line, twice, {7, 8}, first);
    CHECK(tie.label == -1);
    CHECK(tie.cost == 0);
    CHECK(tie.rival == 0);
    CHECK(guess_one(line, twice, {7, 7}, first).label == 7);

    const std::vector<CorpusPrimitive> whole{{0, {0, 40}}};
    CHECK(guess_one(line, whole, {7}, first).label == -1);
    CHECK(guess_one(line, whole, {7}, first, {96, 72, 0.5, 0.8}).label == 7);
}

TEST_CASE("what is equal everywhere, of one frame or not there at all misleads nobody") {
    const MatrixF still = MatrixF::Constant(60, 45, 2.5F);
    const std::vector<CorpusPrimitive> three{{0, {0, 20}}, {0, {20, 40}}, {0, {40, 60}}};
    CHECK(guess_one(still, three, {1, 1, 1}, still.topRows(15)).label == 1);
    CHECK(guess_one(still, three, {1, 2, 1}, still.topRows(15)).label == -1);
    CHECK(guess_one(still, {{0, {3, 4}}}, {4}, still.topRows(1)).label == 4);
    CHECK(guess_one(still, three, {-1, -1, -1}, still.topRows(5)) == LabelGuess{});
    CHECK(guess_one(still, {}, {}, still.topRows(5)) == LabelGuess{});
    CHECK(guess_one(still, three, {1, 1, 1}, still.topRows(0)) == LabelGuess{});
    const KnowledgeBase base(still, three, std::vector<int32_t>{1, 1, 1}, 1);
    CHECK(transfer_labels(base, still, {}, {}, 2).empty());
}

TEST_CASE("knowledge that does not fit together is refused") {
    MatrixF rows = MatrixF::Zero(20, 3);
    const std::vector<CorpusPrimitive> one{{0, {5, 15}}};
    const std::vector<int32_t> label{0};
    CHECK_THROWS_AS(KnowledgeBase(rows, one, std::vector<int32_t>{0, 1}, 1), std::invalid_argument);
    CHECK_THROWS_AS(KnowledgeBase(rows.topRows(10), one, label, 1), std::invalid_argument);
    const KnowledgeBase base(rows, one, label, 1);
    CHECK_THROWS_AS(base.label_of(MatrixF::Zero(9, 4), {}), std::invalid_argument);
    rows(7, 1) = std::nanf("");
    CHECK_THROWS_AS(KnowledgeBase(rows, one, label, 1), std::invalid_argument);
    CHECK_THROWS_AS(transfer_labels(base, rows, one, {}, 1), std::invalid_argument);
}
