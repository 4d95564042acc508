#include "kinetome/models/pose_clusters.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <vector>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

/// Three tight blobs far from each other: BIC has no doubt.
MatrixF three_blobs(int rows) {
    RandomStream random(2, "three_blobs");
    MatrixF points(rows, 2);
    for (int i = 0; i < rows; ++i)
        for (int d = 0; d < 2; ++d)
            points(i, d) = static_cast<float>(50 * (i % 3) * (d + 1) + random.normal());
    return points;
}

PoseClusterOptions choose_by_bic(std::vector<int64_t> clusters) {
    PoseClusterOptions options;
    options.count_rule = ClusterCountRule::bic;
    options.bic_clusters = std::move(clusters);
    return options;
}

void check_same(const PoseClusters& a, const PoseClusters& b) {
    CHECK(a.fit.model.means == b.fit.model.means);
    CHECK(a.fit.model.variances == b.fit.model.variances);
    CHECK(a.fit.model.weights == b.fit.model.weights);
    CHECK(a.fit.history == b.fit.history);
    CHECK(a.fit.mean_log_likelihood == b.fit.mean_log_likelihood);
    REQUIRE(a.tried.size() == b.tried.size());
    for (size_t i = 0; i < a.tried.size(); ++i) {
        CHECK(a.tried[i].clusters == b.tried[i].clusters);
        CHECK(a.tried[i].bayesian_information == b.tried[i].bayesian_information);
    }
}

}  // namespace

TEST_CASE("the number of clusters follows the frames between its bounds, never above them") {
    PoseClusterOptions options;  // n / 25 between 30 and 8000
    CHECK(cluster_count(options, 4653) == 186);
    CHECK(cluster_count(options, 641) == 30);
    CHECK(cluster_count(options, 10) == 10);
    CHECK(cluster_count(options, 2'500'000) == 8000);
    CHECK(cluster_count(options, 1) == 1);
    CHECK(cluster_count(options, 0) == 0);

    options.clusters = 200;
    CHECK(cluster_count(options, 4653) == 200);
    CHECK(cluster_count(options, 150) == 150);
}

TEST_CASE("BIC tries each number once, those above the frames as one") {
    const PoseClusterOptions options = choose_by_bic({50, 20, 50, 300, 200});
    CHECK(cluster_counts(options, 1000) == std::vector<int64_t>{50, 20, 300, 200});
    CHECK(cluster_counts(options, 100) == std::vector<int64_t>{50, 20, 100});
    CHECK(cluster_count(options, 1000) == 300);
}

TEST_CASE("options that name no positive number of clusters are refused") {
    PoseClusterOptions options;
    options.clusters = -1;
    CHECK_THROWS_AS(cluster_counts(options, 100), std::invalid_argument);
    CHECK_THROWS_AS(cluster_counts(choose_by_bic({}), 100), std::invalid_argument);
    CHECK_THROWS_AS(cluster_counts(choose_by_bic({5, 0}), 100), std::invalid_argument);
    options.clusters = 0;
    options.frames_per_cluster = 0;
    CHECK_THROWS_AS(cluster_counts(options, 100), std::invalid_argument);
}

TEST_CASE("BIC finds the number of blobs and reports every number tried") {
    const MatrixF rows = three_blobs(600);
    const PoseClusters clusters =
        fit_pose_clusters(MatrixRows(rows), choose_by_bic({1, 2, 3, 6, 12}), 1);
    CHECK(clusters.clusters() == 3);
    REQUIRE(clusters.tried.size() == 5);
    for (const TriedClusterCount& other : clusters.tried) {
        if (other.clusters == 3) continue;
        CHECK(other.bayesian_information > clusters.tried[2].bayesian_information);
    }
    CHECK(clusters.tried[2].bayesian_information ==
          bayesian_information(clusters.fit, rows.rows()));
}

TEST_CASE("a fit resumed after any iteration of any candidate ends in the same bits") {
    const MatrixF rows = three_blobs(200);
    const PieceLayout layout = layout_rows(200);
    PoseClusterOptions options = choose_by_bic({2, 5, 3});
    options.mixture.restarts = 2;
    options.mixture.max_iterations = 6;
    options.mixture.min_gain = -1;
    std::vector<PoseClusterProgress> reports;
    const PoseClusters whole = fit_pose_clusters(
        MatrixRows(rows, layout), options, 1, {},
        [&](const PoseClusterProgress& progress) { reports.push_back(progress); });
    REQUIRE(reports.size() == 3 * 2 * 6);
    CHECK(reports.front().candidate == 0);
    CHECK(reports.back().candidate == 2);
    CHECK(reports.back().best.tried.size() == 2);
    for (const PoseClusterProgress& progress : reports) {
        CAPTURE(progress.candidate, progress.mixture.restart, progress.mixture.iteration);
        check_same(fit_pose_clusters(MatrixRows(rows, layout), options, 1, {}, {}, &progress),
                   whole);
    }
}

TEST_CASE("a fit stops between iterations when asked to, and goes on from its last report") {
    const MatrixF rows = three_blobs(200);
    const PieceLayout layout = layout_rows(200);
    PoseClusterOptions options = choose_by_bic({4, 3});
    options.mixture.min_gain = -1;
    options.mixture.max_iterations = 5;
    std::atomic<bool> asked{false};
    PoseClusterProgress last;
    int reports = 0;
    CHECK_THROWS_AS(fit_pose_clusters(MatrixRows(rows, layout), options, 1, StopToken(asked),
                                      [&](const PoseClusterProgress& progress) {
                                          last = progress;
                                          asked = ++reports == 7;
                                      }),
                    Interrupted);
    CHECK(reports == 7);
    check_same(fit_pose_clusters(MatrixRows(rows, layout), options, 1, {}, {}, &last),
               fit_pose_clusters(MatrixRows(rows, layout), options, 1));
}

TEST_CASE("one frame is one cluster, no frames are refused") {
    const PoseClusters clusters =
        fit_pose_clusters(MatrixRows(three_blobs(1)), PoseClusterOptions{}, 1);
    CHECK(clusters.clusters() == 1);
    CHECK(clusters.fit.model.means.allFinite());
    CHECK_THROWS_AS(fit_pose_clusters(MatrixRows(three_blobs(0)), PoseClusterOptions{}, 1),
                    std::invalid_argument);
}
