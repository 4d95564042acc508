// From takes of the CMU collection to motion strings. The expected values were reached by an
// independent implementation of the same method.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <vector>

#include "kinetome/features/pose_vector.h"
#include "kinetome/math/moments.h"
#include "kinetome/math/pca.h"
#include "kinetome/models/motion_string.h"
#include "kinetome/models/pose_clusters.h"
#include "support/cmu_take.h"
#include "support/test_corpus.h"

using namespace kinetome;

namespace {

struct PoseVectorsOfTakes {
    MatrixF rows;
    std::vector<int64_t> clip_frames;
    Pca pca;
};

PoseVectorsOfTakes pose_vectors_of(const std::filesystem::path& corpus,
                                   const std::vector<std::string>& names) {
    PoseVectorsOfTakes takes;
    VectorD floor;
    for (const std::string& name : names) {
        const Clip take = cmu_take(corpus, name);
        const auto columns = pose_vector_columns(*take.skeleton);
        floor.resize(static_cast<Eigen::Index>(columns.size()));
        for (size_t c = 0; c < columns.size(); ++c)
            floor[static_cast<Eigen::Index>(c)] = columns[c].floor;
        takes.rows.conservativeResize(takes.rows.rows() + take.frames(), floor.size());
        takes.rows.bottomRows(take.frames()) = pose_vectors(*take.skeleton, take.motion, take.rate);
        takes.clip_frames.push_back(take.frames());
    }
    takes.pca = fit_pca(moments_of(takes.rows), floor, PoseClusterOptions{}.variance_share);
    return takes;
}

}  // namespace

TEST_CASE("real takes have as many components at 70 % as the method's reference") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    const struct {
        std::vector<std::string> takes;
        int64_t components;
    } references[] = {
        {{"02_01", "02_02"}, 3}, {{"02_05"}, 3}, {{"03_03"}, 10}, {{"13_29"}, 5}, {{"14_14"}, 5}};
    for (const auto& reference : references) {
        CAPTURE(reference.takes);
        const int64_t components = pose_vectors_of(*corpus, reference.takes).pca.dimension();
        CHECK(std::abs(components - reference.components) <= 1);
    }
}

TEST_CASE("exercises of 14_14 at 200 clusters give a string of about 403 letters") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    const PoseVectorsOfTakes takes = pose_vectors_of(*corpus, {"14_14"});
    const MatrixF projected = takes.pca.project(takes.rows);
    PoseClusterOptions options;
    options.clusters = 200;
    options.mixture.min_gain = 1e-3;
    const PoseClusters clusters = fit_pose_clusters(MatrixRows(projected), options, 2);
    const MotionString string = make_motion_string(
        likeliest_clusters(clusters.fit.model, MatrixRows(projected), 2), takes.clip_frames);

    CHECK(string.size() > 403 / 1.3);
    CHECK(string.size() < 403 * 1.3);
    const auto lambda = static_cast<double>(longest_substring(string, 200));
    CHECK(lambda == Approx(17).epsilon(0.3));
    // The method's notes: tau is about 5 at 3 components, 9 at 8, and a row has 2 to 3.5 ones.
    const double tau = adjacent_distance(string, clusters.fit.model, 0.5);
    CHECK(tau > 4);
    CHECK(tau < 10);
    const AccessibilityMatrix matrix = accessibility(clusters.fit.model, tau, 2);
    const double ones_a_row =
        static_cast<double>(matrix.count()) / static_cast<double>(matrix.letters());
    CHECK(ones_a_row > 1.5);
    CHECK(ones_a_row < 4);
}
