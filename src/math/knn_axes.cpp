#include "knn_axes.h"

#include <algorithm>
#include <limits>

#include "kinetome/math/moments.h"
#include "kinetome/math/symmetric_eigen.h"

namespace kinetome {
namespace {

constexpr int64_t most_sampled_rows = 16'384;
/// Of the variance. Poses stacked with their neighbours in time need a third of their columns.
constexpr double kept_share = 0.99;

/// Rounding to float takes half an epsilon of a row's length, sums in double next to nothing.
constexpr double slack_share = 2 * double(std::numeric_limits<float>::epsilon());

Moments sampled_moments(const MatrixFView& rows) {
    const int64_t step = std::max<int64_t>(1, rows.rows() / most_sampled_rows);
    const int64_t count = (rows.rows() + step - 1) / step;
    return moments_of(Eigen::Map<const MatrixF, 0, Eigen::OuterStride<>>(
        rows.data(), count, rows.cols(), Eigen::OuterStride<>(step * rows.outerStride())));
}

int64_t fewest_with(const VectorD& variances, double share) {
    const double wanted = share * variances.sum();
    int64_t count = 0;
    for (double sum = 0; sum < wanted && count < variances.size(); ++count) {
        sum += variances[count];
    }
    return std::max<int64_t>(count, 1);
}

}  // namespace

LeadingAxes::LeadingAxes(const MatrixFView& rows) {
    if (rows.rows() == 0) {
        mean_ = VectorD::Zero(rows.cols());
        axes_ = MatrixD::Identity(rows.cols(), 1);
        return;
    }
    const Moments moments = sampled_moments(rows);
    const SymmetricEigen eigen = symmetric_eigen(moments.scatter);
    mean_ = moments.mean;
    axes_ = eigen.vectors.leftCols(fewest_with(eigen.values, kept_share));
}

void LeadingAxes::project(const MatrixFView& rows, MatrixF& projected, VectorF& slack) const {
    constexpr double most = std::numeric_limits<float>::max();
    const MatrixD centred = rows.cast<double>().rowwise() - mean_.transpose();
    // What is cut off at the ends of float's range only brings rows nearer to each other.
    projected = (centred * axes_).cwiseMax(-most).cwiseMin(most).cast<float>();
    slack = (centred.rowwise().norm() * slack_share).cwiseMin(most).cast<float>();
}

}  // namespace kinetome
