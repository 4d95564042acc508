#include "kinetome/models/signature_match.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <stdexcept>

#include "kinetome/base/random.h"
#include "kinetome/math/warp.h"

using namespace kinetome;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Leaves on a line, 30 mm from one to the next.
MatrixF distances_between(const Signature& query, const Signature& text) {
    MatrixF distances(query.size(), text.size());
    for (size_t i = 0; i < query.size(); ++i) {
        for (size_t j = 0; j < text.size(); ++j) {
            distances(Eigen::Index(i), Eigen::Index(j)) =
                30.0F * float(std::abs(query[i].leaf - text[j].leaf));
        }
    }
    return distances;
}

MatrixD by_frame(const Signature& query, const Signature& text) {
    const MatrixF runs = distances_between(query, text);
    MatrixD distances(frame_count(query), frame_count(text));
    for (Eigen::Index i = 0; i < distances.rows(); ++i) {
        for (Eigen::Index j = 0; j < distances.cols(); ++j) {
            distances(i, j) = double(runs(run_at(query, i), run_at(text, j)));
        }
    }
    return distances;
}

std::vector<SignatureMatch> matches_of(const Signature& query, const Signature& text,
                                       const SignatureMatchOptions& options) {
    if (options.rule != MatchRule::pace) {
        return match_runs(query, text, distances_between(query, text), options);
    }
    const MatrixF frames = by_frame(query, text).cast<float>();
    const int64_t rows = std::max<int64_t>(1, frames.rows() / options.step);
    MatrixF moments(rows, frames.cols() / options.step);
    for (Eigen::Index i = 0; i < moments.rows(); ++i) {
        for (Eigen::Index j = 0; j < moments.cols(); ++j) {
            moments(i, j) = frames((2 * i + 1) * frames.rows() / (2 * rows),
                                   j * options.step + options.step / 2);
        }
    }
    return match_paces(frame_count(query), moments, options);
}

/// Runs of 1 to `longest` frames.
Signature random_signature(uint64_t seed, int64_t runs, uint64_t longest) {
    RandomStream random(seed, "signature");
    std::vector<int32_t> leaves;
    for (int64_t run = 0; run < runs; ++run) {
        auto leaf = static_cast<int32_t>(random.below(6));
        if (!leaves.empty() && leaves.back() == leaf) leaf = (leaf + 1) % 6;
        leaves.insert(leaves.end(), 1 + random.below(longest), leaf);
    }
    return make_signature(leaves);
}

/// Every run `factor` times as long.
Signature stretched(const Signature& signature, double factor) {
    Signature result;
    for (const SignatureRun& run : signature) {
        const auto first = static_cast<int32_t>(std::lround(run.first_frame * factor));
        const auto end = static_cast<int32_t>(std::lround(run.end_frame() * factor));
        result.push_back({run.leaf, first, end - first});
    }
    return result;
}

/// All ends, whatever they overlap and however long they are.
SignatureMatchOptions every_end(MatchRule rule) {
    SignatureMatchOptions options;
    options.rule = rule;
    options.shortest = 0;
    options.longest = infinite;
    options.overlap = 1;
    options.step = 1;
    return options;
}

std::map<int64_t, double> distance_by_end(const std::vector<SignatureMatch>& matches) {
    std::map<int64_t, double> distances;
    for (const SignatureMatch& match : matches) distances[match.frames.end] = match.distance;
    return distances;
}

/// The nearest alignment to every end by laying the query onto every part of the text apart.
std::map<int64_t, double> nearest_parts(const MatrixD& distances, const WarpOptions& steps) {
    std::map<int64_t, double> nearest;
    for (int64_t first = 0; first < distances.cols(); ++first) {
        for (int64_t end = first + 1; end <= distances.cols(); ++end) {
            const MatrixD part = distances.middleCols(first, end - first);
            const double total = warp(part, steps).total;
            if (total == infinite) continue;
            const double mean = total / double(distances.rows());
            const auto known = nearest.emplace(end, mean).first;
            known->second = std::min(known->second, mean);
        }
    }
    return nearest;
}

/// Least cost of editing runs [i, n) of the query into runs [j, end) of the text, by trying all.
double edit_cost(const MatrixF& distances, const SignatureMatchOptions& options, int64_t i,
                 int64_t j, int64_t end) {
    const auto cost = [&](int64_t a, int64_t b) {
        if (a < 0 || b < 0 || a >= distances.rows() || b >= distances.cols()) return infinite;
        return std::min(double(distances(a, b)), options.farthest);
    };
    if (i == distances.rows() && j == end) return 0;
    double least = infinite;
    if (i < distances.rows() && j < end) {
        least = cost(i, j) + edit_cost(distances, options, i + 1, j + 1, end);
    }
    if (i < distances.rows()) {
        const double omission = std::min(cost(i, j - 1), cost(i, j)) + options.gap;
        least = std::min(least, omission + edit_cost(distances, options, i + 1, j, end));
    }
    if (j < end && i > 0) {
        const double insertion = std::min(cost(i - 1, j), cost(i, j)) + options.gap;
        least = std::min(least, insertion + edit_cost(distances, options, i, j + 1, end));
    }
    return least;
}

void check_equal(const std::map<int64_t, double>& found,
                 const std::map<int64_t, double>& expected) {
    REQUIRE(found.size() == expected.size());
    for (const auto& [end, distance] : expected) {
        INFO("end " << end);
        REQUIRE(found.count(end) == 1);
        CHECK(found.at(end) == Approx(distance).margin(1e-4));
    }
}

}  // namespace

TEST_CASE("paced matches are those of warping the query onto every part of the text") {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        const Signature query = random_signature(seed, 5, 4),
                        text = random_signature(90 + seed, 14, 4);
        const WarpOptions steps{slope_limited_steps(), WarpWeight::first};
        check_equal(distance_by_end(matches_of(query, text, every_end(MatchRule::pace))),
                    nearest_parts(by_frame(query, text), steps));
    }
}

TEST_CASE("repeated runs match as warping without limits onto every part of the text does") {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        // Runs of one frame: the frames of a match are its runs.
        const Signature query = random_signature(seed, 6, 1),
                        text = random_signature(50 + seed, 12, 1);
        MatrixD distances = distances_between(query, text).cast<double>();
        distances = distances.cwiseMin(SignatureMatchOptions{}.farthest);
        check_equal(distance_by_end(matches_of(query, text, every_end(MatchRule::repeats))),
                    nearest_parts(distances, {unlimited_steps(), WarpWeight::cells}));
    }
}

TEST_CASE("edited runs match as trying all edits of every part of the text does") {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        const Signature query = random_signature(seed, 5, 1),
                        text = random_signature(70 + seed, 7, 1);
        const SignatureMatchOptions options = every_end(MatchRule::edit);
        const MatrixF distances = distances_between(query, text);
        const auto found = distance_by_end(matches_of(query, text, options));
        for (int64_t end = 1; end <= distances.cols(); ++end) {
            double least = infinite;
            for (int64_t first = 0; first < end; ++first) {
                least = std::min(least, edit_cost(distances, options, 0, first, end));
            }
            if (found.count(end) == 0) {  // leaving out all of the query is no match
                CHECK(edit_cost(distances, options, 0, end, end) <= least);
            } else {
                CHECK(found.at(end) == Approx(least / double(query.size())).margin(1e-4));
            }
        }
        CHECK(found.size() > 2);
    }
}

TEST_CASE("a motion at another tempo is found at distance 0 where it is") {
    const Signature text = random_signature(8, 60, 30);
    const Signature query = part_of(text, {200, 440});
    for (const double factor : {0.7, 1.0, 1.4}) {
        SignatureMatchOptions options;
        options.step = 4;
        const SignatureMatch paced = matches_of(stretched(query, factor), text, options).at(0);
        CHECK(paced.distance < 2);
        CHECK(std::abs(paced.frames.first - 200) <= 30);  // a run: its frames are all alike
        CHECK(std::abs(paced.frames.end - 440) <= 30);
        for (const MatchRule rule : {MatchRule::repeats, MatchRule::edit}) {
            options.rule = rule;
            CHECK(matches_of(stretched(query, factor), text, options).at(0).distance == 0);
        }
    }
}

TEST_CASE("no match is shorter than half the query or longer than twice") {
    const Signature text = random_signature(8, 60, 30);
    const Signature query = stretched(part_of(text, {200, 440}), 2.5);
    for (const MatchRule rule : {MatchRule::pace, MatchRule::repeats, MatchRule::edit}) {
        SignatureMatchOptions options;
        options.rule = rule;
        const auto matches = matches_of(query, text, options);
        for (const SignatureMatch& match : matches) {
            CHECK(match.frames.size() >= frame_count(query) / 2);
            CHECK(match.frames.size() <= frame_count(query) * 2);
            CHECK(match.distance > 0);
        }
    }
}

TEST_CASE("matches come nearest first, apart from each other and within the tolerance") {
    const Signature text = random_signature(5, 200, 20), query = part_of(text, {300, 420});
    for (const MatchRule rule : {MatchRule::pace, MatchRule::repeats, MatchRule::edit}) {
        SignatureMatchOptions options;
        options.rule = rule;
        const auto all = matches_of(query, text, options);
        REQUIRE(all.size() > 5);
        CHECK(std::ranges::is_sorted(all, std::less<>()));
        for (size_t i = 0; i < all.size(); ++i) {
            for (size_t j = 0; j < i; ++j) {
                CHECK_FALSE(is_same_place(all[i].frames, all[j].frames, options.overlap));
            }
        }
        options.tolerance = all[2].distance;
        const auto near = matches_of(query, text, options);
        CHECK(near.size() < all.size());
        CHECK(std::ranges::all_of(
            near, [&](const auto& match) { return match.distance <= options.tolerance; }));
        CHECK(near.front() == all.front());
    }
}

TEST_CASE("a run that was put in costs the gap beside a near leaf, and more beside a far one") {
    const Signature query = make_signature(std::vector<int32_t>{1, 2, 3, 4});
    SignatureMatchOptions options;
    options.rule = MatchRule::edit;
    const auto distance = [&](const std::vector<int32_t>& leaves) {
        return matches_of(query, make_signature(leaves), options).at(0).distance;
    };
    CHECK(distance({1, 2, 3, 4}) == 0);
    CHECK(distance({1, 2, 1, 3, 4}) == Approx((30 + options.gap) / 4));
    CHECK(distance({1, 2, 6, 3, 4}) == Approx((90 + options.gap) / 4));
    CHECK(distance({1, 2, 4}) == Approx((30 + options.gap) / 4));
}

TEST_CASE("exact matches have the query's leaves, however long the runs are") {
    const Signature text = make_signature(std::vector<int32_t>{1, 1, 2, 1, 2, 2, 2, 1, 3, 1, 2, 1});
    CHECK(exact_matches(make_signature(std::vector<int32_t>{1, 2, 2, 1}), text) ==
          std::vector<int64_t>{0, 2, 6});
    CHECK(exact_matches(make_signature(std::vector<int32_t>{3, 2}), text).empty());
    CHECK(exact_matches({}, text).empty());
    CHECK(exact_matches(text, {}).empty());
    CHECK(matched_frames(make_signature(std::vector<int32_t>{1, 2, 2, 1}), text, 0, 2) ==
          RowRange{1, 4});
}

TEST_CASE("nothing matches nothing, and distances must fit") {
    const Signature query = random_signature(1, 3, 4), text = random_signature(2, 5, 4);
    SignatureMatchOptions by_runs;
    by_runs.rule = MatchRule::edit;
    CHECK(match_runs({}, text, MatrixF(0, text.size()), by_runs).empty());
    CHECK(match_runs(query, {}, MatrixF(query.size(), 0), by_runs).empty());
    CHECK_THROWS_AS(match_runs(query, text, MatrixF(1, 1), by_runs), std::invalid_argument);
    CHECK_THROWS_AS(match_runs(query, text, distances_between(query, text), {}),
                    std::invalid_argument);
    CHECK(match_paces(0, MatrixF(0, 4), {}).empty());
    CHECK(match_paces(40, MatrixF(4, 0), {}).empty());
    SignatureMatchOptions options;
    options.step = 0;
    CHECK_THROWS_AS(match_paces(40, MatrixF::Zero(4, 4), options), std::invalid_argument);
}
