#include "member_metric.h"

#include <algorithm>

#include "kinetome/math/moments.h"
#include "kinetome/math/symmetric_eigen.h"

namespace kinetome {
namespace {

/// They hold more than nineteen twentieths of what the points of bodies vary.
constexpr Eigen::Index most_axes = 16;
/// Of the mean variance, added to all: few members say little about axes they hardly vary in.
constexpr double shrinkage = 0.1;

MatrixF along_main_axes(const MatrixFView& rows, std::span<const RowRange> members) {
    Eigen::Index count = 0;
    for (const RowRange& member : members) count += member.size();
    MatrixF sample(count, rows.cols());
    count = 0;
    for (const RowRange& member : members) {
        sample.middleRows(count, member.size()) = rows.middleRows(member.first, member.size());
        count += member.size();
    }
    const Moments moments = moments_of(sample);
    const MatrixD axes =
        symmetric_eigen(moments.scatter).vectors.leftCols(std::min(most_axes, rows.cols()));
    MatrixF along(rows.rows(), axes.cols());
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        along.row(i) =
            ((rows.row(i).cast<double>() - moments.mean.transpose()) * axes).cast<float>();
    }
    return along;
}

/// Of equally near rows the first.
int64_t nearest_row(const MatrixF& rows, int64_t to, const RowRange& among) {
    int64_t nearest = among.first;
    float least = (rows.row(nearest) - rows.row(to)).squaredNorm();
    for (int64_t row = among.first + 1; row < among.end; ++row) {
        const float distance = (rows.row(row) - rows.row(to)).squaredNorm();
        if (distance >= least) continue;
        least = distance;
        nearest = row;
    }
    return nearest;
}

/// Differences of members of one bundle, their products added up.
struct Differences {
    MatrixD products;  ///< d × d
    int64_t count = 0;
};

Differences differences(const MatrixF& rows, std::span<const RowRange> members,
                        std::span<const std::vector<size_t>> bundles) {
    Differences sum{MatrixD::Zero(rows.cols(), rows.cols())};
    for (const std::vector<size_t>& bundle : bundles) {
        for (const size_t one : bundle) {
            for (const size_t other : bundle) {
                if (one == other) continue;
                for (int64_t row = members[one].first; row < members[one].end; ++row) {
                    const Eigen::RowVectorXd difference =
                        (rows.row(row) - rows.row(nearest_row(rows, row, members[other])))
                            .cast<double>();
                    sum.products += difference.transpose() * difference;
                    ++sum.count;
                }
            }
        }
    }
    return sum;
}

}  // namespace

MatrixF rows_by_member_metric(const MatrixFView& rows, std::span<const RowRange> members,
                              std::span<const std::vector<size_t>> bundles) {
    MatrixF along = along_main_axes(rows, members);
    Differences within = differences(along, members, bundles);
    const auto axes = static_cast<double>(along.cols());
    const double mean = within.products.trace() / axes;
    if (!(mean > 0)) return along;
    within.products.diagonal().array() += shrinkage * mean;
    const SymmetricEigen spread = symmetric_eigen(within.products);
    // Of unit mean variance, so that distances stay in the order of those along the axes.
    const VectorD scale = (mean / spread.values.array()).sqrt();
    const MatrixF whitening =
        (spread.vectors * scale.asDiagonal() * spread.vectors.transpose()).cast<float>();
    for (Eigen::Index i = 0; i < along.rows(); ++i) along.row(i) = along.row(i) * whitening;
    return along;
}

}  // namespace kinetome
