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
#include "kinetome/models/movement_rows.h"

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

constexpr LabelLimits usual{108, 0.85};

LabelGuess guess_one(const MatrixF& known, const std::vector<CorpusPrimitive>& primitives,
                     const std::vector<int32_t>& labels, const MatrixF& asked,
                     const LabelLimits& limits = usual) {
    return KnowledgeBase(known, primitives, labels).label_of(asked, limits);
}

/// Generated takes of which every other one is known.
struct HalfKnown {
    explicit HalfKnown(int64_t takes) : all(generated_primitives(takes)) {
        all.features = movement_rows(all.features, all.primitives);
        const std::vector<int32_t> labels = numbers_of(all.labels);
        for (size_t p = 0; p < labels.size(); ++p) {
            const bool is_known = all.primitives[p].clip % 2 == 0;
            known.push_back(is_known ? labels[p] : -1);
            if (is_known) continue;
            asked.push_back(all.primitives[p]);
            truth.push_back(labels[p]);
        }
    }
    MatrixFView rows(const CorpusPrimitive& primitive) const {
        return all.features.middleRows(primitive.rows.first, primitive.rows.size());
    }

    GeneratedPrimitives all;
    std::vector<int32_t> known, truth;
    std::vector<CorpusPrimitive> asked;
};

/// What each label costs, by comparison with every run of known primitives.
std::map<int32_t, double> costs_of_labels(const HalfKnown& half, const MatrixFView& query,
                                          int64_t left_out_clip = -1) {
    const auto& primitives = half.all.primitives;
    std::map<int32_t, double> costs;
    for (size_t first = 0; first < primitives.size();) {
        size_t end = first + 1;
        while (end < primitives.size() && half.known[end] == half.known[first] &&
               adjoin(primitives[end - 1], primitives[end])) {
            ++end;
        }
        const RowRange run{primitives[first].rows.first, primitives[end - 1].rows.end};
        if (half.known[first] >= 0 && primitives[first].clip != left_out_clip) {
            double& cost = costs.emplace(half.known[first], infinite).first->second;
            for (const WarpPath& path :
                 warp_matches(query, half.all.features.middleRows(run.first, run.size()), {})) {
                cost = std::min(cost, path.mean);
            }
        }
        first = end;
    }
    return costs;
}

}  // namespace

TEST_CASE("a label is given exactly where comparing with every known run would give it") {
    const HalfKnown half(24);
    const KnowledgeBase base(half.all.features, half.all.primitives, half.known);
    int64_t given = 0, rivalled = 0, far = 0;
    for (const CorpusPrimitive& primitive : half.asked) {
        const auto query = half.rows(primitive);
        double nearest = infinite, next = infinite;
        int32_t label = -1;
        for (const auto& [other, cost] : costs_of_labels(half, query)) {
            next = std::min(next, std::max(cost, nearest));
            if (cost < nearest) label = other;
            nearest = std::min(nearest, cost);
        }
        const LabelGuess guess = base.label_of(query, {80, 0.5});
        if (nearest > 80) {
            CHECK(guess == LabelGuess{});
            ++far;
            continue;
        }
        CHECK(guess.cost == nearest);
        const bool leads = next > nearest / 0.5;
        CHECK(guess.rival == (leads ? infinite : next));
        CHECK(guess.label == (leads ? label : -1));
        REQUIRE(guess.source >= 0);
        CHECK(half.known[size_t(guess.source)] == label);
        ++(leads ? given : rivalled);
    }
    CAPTURE(given, rivalled, far);
    CHECK(given > 10);
    CHECK(rivalled > 0);
    CHECK(far > 0);
}

TEST_CASE("limits are learned of what known primitives cost by other takes") {
    const HalfKnown half(24);
    const KnowledgeBase base(half.all.features, half.all.primitives, half.known);
    std::vector<double> costs, shares;
    for (size_t p = 0; p < half.known.size(); ++p) {
        if (half.known[p] < 0) continue;
        const CorpusPrimitive& primitive = half.all.primitives[p];
        auto others = costs_of_labels(half, half.rows(primitive), primitive.clip);
        const auto own = others.find(half.known[p]);
        if (own == others.end() || own->second == infinite) continue;
        const double cost = own->second;
        others.erase(own);
        double next = infinite;
        for (const auto& [label, other] : others) next = std::min(next, other);
        costs.push_back(cost);
        shares.push_back(cost / next);
    }
    std::ranges::sort(costs);
    std::ranges::sort(shares);
    const LabelTransferOptions options{1000, 0.01, 0.8};
    const auto rank = size_t(std::ceil(0.8 * double(costs.size() + 1))) - 1;
    REQUIRE(rank < costs.size());
    const LabelLimits limits = base.limits(options, 1);
    CHECK(limits.threshold == costs[rank]);
    CHECK(limits.lead == std::min(1.0, shares[rank]));
    const LabelLimits again = base.limits(options, 3);
    CHECK(again.threshold == limits.threshold);
    CHECK(again.lead == limits.lead);

    const LabelLimits bounded = base.limits({costs[rank] / 2, 0.99, 0.8}, 1);
    CHECK(bounded.threshold == costs[rank] / 2);
    CHECK(bounded.lead >= 0.99);
    const LabelLimits given = base.limits({90, 0.7, 1}, 1);
    CHECK(given.threshold == 90);
    CHECK(given.lead == 0.7);
}

TEST_CASE("too few known primitives teach no limits") {
    const MatrixF rows = MatrixF::Zero(40, 3);
    const std::vector<CorpusPrimitive> two{{0, {0, 20}}, {1, {20, 40}}};
    const std::vector<int32_t> labels{0, 0};
    const LabelLimits limits = KnowledgeBase(rows, two, labels).limits({90, 0.7, 0.95}, 1);
    CHECK(limits.threshold == 90);
    CHECK(limits.lead == 0.7);
}

TEST_CASE("labels of generated motion are almost never wrong and mostly found") {
    const HalfKnown half(80);
    const KnowledgeBase base(half.all.features, half.all.primitives, half.known);
    const auto guesses = transfer_labels(base, half.all.features, half.asked, {}, 1);
    CHECK(guesses == transfer_labels(base, half.all.features, half.asked, {}, 3));
    std::vector<int32_t> given;
    for (const LabelGuess& guess : guesses) given.push_back(guess.label);
    const LabelCounts counts = label_table(half.truth, given, 12).all;
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
    const KnowledgeBase base(all.features, all.primitives, known);
    for (const LabelGuess& guess : transfer_labels(base, all.features, asked, {}, 1)) {
        given.push_back(guess.label);
    }
    CHECK(given == truth);
}

TEST_CASE("no label is given where none is near or two are as near") {
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
    const KnowledgeBase base(still, three, std::vector<int32_t>{1, 1, 1});
    CHECK(transfer_labels(base, still, {}, {}, 2).empty());
}

TEST_CASE("knowledge that does not fit together is refused") {
    MatrixF rows = MatrixF::Zero(20, 3);
    const std::vector<CorpusPrimitive> one{{0, {5, 15}}};
    const std::vector<int32_t> label{0};
    CHECK_THROWS_AS(KnowledgeBase(rows, one, std::vector<int32_t>{0, 1}), std::invalid_argument);
    CHECK_THROWS_AS(KnowledgeBase(rows.topRows(10), one, label), std::invalid_argument);
    const KnowledgeBase base(rows, one, label);
    CHECK_THROWS_AS(base.label_of(MatrixF::Zero(9, 4), usual), std::invalid_argument);
    CHECK_THROWS_AS(base.limits({0, 0.8, 1}, 1), std::invalid_argument);
    CHECK_THROWS_AS(base.limits({100, 1.1, 1}, 1), std::invalid_argument);
    CHECK_THROWS_AS(base.limits({100, 0.8, 0}, 1), std::invalid_argument);
    rows(7, 1) = std::nanf("");
    CHECK_THROWS_AS(KnowledgeBase(rows, one, label), std::invalid_argument);
    CHECK_THROWS_AS(transfer_labels(base, rows, one, {}, 1), std::invalid_argument);
}
