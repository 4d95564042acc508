#include "kinetome/models/skeleton_fit.h"

#include <catch2/catch.hpp>

#include "kinetome/synthesis/take.h"

using namespace kinetome;

namespace {

std::span<const float> row_of(const MatrixF& rows, Eigen::Index row) {
    return {rows.data() + row * rows.cols(), static_cast<size_t>(rows.cols())};
}

}  // namespace

TEST_CASE("a skeleton fitted to its own joints has them where they are") {
    const Clip clip = perform(plan_take(2, 240, 1, 1, 9), make_subject(1, 9), 9);
    const MatrixF positions = joint_positions(clip);
    SkeletonFit fit(clip.skeleton);
    const Eigen::Index last = clip.frames() - 1;
    Clip fitted = clip;
    fitted.motion =
        fit_frames(fit, positions, row_of(clip.motion, 0), row_of(clip.motion, last), last);
    const MatrixF reached = joint_positions(fitted);
    CHECK((reached - positions).cwiseAbs().maxCoeff() < 0.3F);
    CHECK((reached - positions).norm() / std::sqrt(double(reached.rows() * reached.cols() / 3)) <
          0.05);
    // No joint spins where its place does not tell how it is turned.
    float greatest = 0;
    for (Eigen::Index i = 1; i <= last; ++i) {
        const auto turns = fitted.motion.row(i).tail(clip.motion.cols() - 6) -
                           fitted.motion.row(i - 1).tail(clip.motion.cols() - 6);
        greatest = std::max(greatest, turns.cwiseAbs().maxCoeff());
    }
    CHECK(greatest < 0.5F);
}

TEST_CASE("a skeleton comes as near as it can to places it cannot reach") {
    const Clip clip = perform(plan_take(2, 30, 1, 1, 9), make_subject(1, 9), 9);
    MatrixF positions = joint_positions(clip);
    positions *= 1.05F;  // of a body that is 5 % larger
    SkeletonFit fit(clip.skeleton);
    Clip fitted = clip;
    fitted.motion = fit_frames(fit, positions, row_of(clip.motion, 0), row_of(clip.motion, 29), 29);
    CHECK(fitted.motion.allFinite());
    const MatrixF reached = joint_positions(fitted);
    CHECK((reached - positions).norm() < (joint_positions(clip) - positions).norm() / 2);
}

TEST_CASE("a first frame far from where the fit begins is reached, too") {
    for (const int64_t take : {1, 2, 3, 4}) {
        const Clip clip = perform(plan_take(take, 60, 1, 1, 9), make_subject(1, 9), 9);
        const MatrixF positions = joint_positions(clip);
        VectorF start = VectorF::Zero(clip.motion.cols());
        start.head(6) = clip.motion.row(0).head(6);  // the root alone stands where it is
        const std::span<const float> from(start.data(), static_cast<size_t>(start.size()));
        SkeletonFit fit(clip.skeleton);
        Clip fitted = clip;
        fitted.motion = fit_frames(fit, positions, from, from, clip.frames());
        CHECK((joint_positions(fitted) - positions).row(0).cwiseAbs().maxCoeff() < 1);
    }
}

TEST_CASE("positions of another skeleton are refused") {
    const Clip clip = perform(plan_take(2, 30, 1, 1, 9), make_subject(1, 9), 9);
    SkeletonFit fit(clip.skeleton);
    std::vector<float> dofs(static_cast<size_t>(clip.motion.cols())), few(9);
    CHECK_THROWS_AS(fit.fit(few, dofs, dofs), std::invalid_argument);
}
