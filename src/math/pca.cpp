#include "kinetome/math/pca.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "kinetome/math/symmetric_eigen.h"

namespace kinetome {
namespace {

void check(const Moments& moments, const VectorD& floor, double share) {
    if (moments.count < 2) {
        throw std::invalid_argument("principal components need at least two rows, not " +
                                    std::to_string(moments.count));
    }
    if (moments.dimension() == 0) {
        throw std::invalid_argument("principal components need at least one column");
    }
    if (floor.size() != moments.dimension()) {
        throw std::invalid_argument("a floor of " + std::to_string(floor.size()) +
                                    " entries was given for " +
                                    std::to_string(moments.dimension()) + " columns");
    }
    if (!(share > 0 && share <= 1)) {
        throw std::invalid_argument("the share of the variance to keep must lie in (0, 1], not " +
                                    std::to_string(share));
    }
    for (int64_t j = 0; j < floor.size(); ++j) {
        if (!(floor[j] > 0)) {
            throw std::invalid_argument("the least scale of column " + std::to_string(j) +
                                        " must be positive");
        }
        if (!std::isfinite(moments.mean[j]) || !std::isfinite(moments.scatter(j, j))) {
            throw std::invalid_argument("column " + std::to_string(j) +
                                        " holds a value that is not finite");
        }
    }
}

VectorD floored_deviations(const Moments& moments, const VectorD& floor) {
    VectorD scale(moments.dimension());
    for (int64_t j = 0; j < scale.size(); ++j) {
        const double variance = moments.scatter(j, j) / static_cast<double>(moments.count - 1);
        scale[j] = std::max(std::sqrt(variance), floor[j]);
    }
    return scale;
}

MatrixD standardised_covariance(const Moments& moments, const VectorD& scale) {
    MatrixD covariance(moments.dimension(), moments.dimension());
    for (int64_t i = 0; i < covariance.rows(); ++i) {
        for (int64_t j = 0; j < covariance.cols(); ++j) {
            covariance(i, j) = moments.scatter(i, j) / static_cast<double>(moments.count - 1) /
                               (scale[i] * scale[j]);
        }
    }
    return covariance;
}

/// Fewest leading variances that hold the share. The whole is summed in the same order as its
/// parts, so that a share of 1 is reached exactly.
int64_t components_holding(const VectorD& variances, double share) {
    double total = 0;
    for (const double variance : variances) total += variance;
    double held = 0;
    for (int64_t kept = 0; kept < variances.size(); ++kept) {
        held += variances[kept];
        if (held >= share * total) return kept + 1;
    }
    return variances.size();
}

}  // namespace

double Pca::kept_share() const {
    double kept = 0, total = 0;
    for (int64_t i = 0; i < variances.size(); ++i) {
        total += variances[i];
        if (i < dimension()) kept = total;
    }
    return total > 0 ? kept / total : 1.0;
}

MatrixF Pca::project(const MatrixFView& rows) const {
    if (rows.cols() != mean.size()) {
        throw std::invalid_argument("rows of " + std::to_string(rows.cols()) +
                                    " columns were given to components of " +
                                    std::to_string(mean.size()));
    }
    MatrixF projected(rows.rows(), dimension());
    std::vector<double> sums(static_cast<size_t>(dimension()));
    for (int64_t i = 0; i < rows.rows(); ++i) {
        std::fill(sums.begin(), sums.end(), 0.0);
        for (int64_t j = 0; j < rows.cols(); ++j) {
            const double standardised = (double(rows(i, j)) - mean[j]) / scale[j];
            const double* const loadings = components.data() + j * dimension();
            for (size_t k = 0; k < sums.size(); ++k) sums[k] += standardised * loadings[k];
        }
        for (size_t k = 0; k < sums.size(); ++k) {
            projected(i, static_cast<int64_t>(k)) = static_cast<float>(sums[k]);
        }
    }
    return projected;
}

void pack(Packer& out, const Pca& pca) {
    pack(out, pca.mean);
    pack(out, pca.scale);
    pack(out, pca.components);
    pack(out, pca.variances);
}

void unpack(Unpacker& in, Pca& pca) {
    unpack(in, pca.mean);
    unpack(in, pca.scale);
    unpack(in, pca.components);
    unpack(in, pca.variances);
}

Pca fit_pca(const Moments& moments, const VectorD& floor, double share) {
    check(moments, floor, share);
    Pca pca;
    pca.mean = moments.mean;
    pca.scale = floored_deviations(moments, floor);
    SymmetricEigen eigen = symmetric_eigen(standardised_covariance(moments, pca.scale));
    pca.variances = eigen.values.cwiseMax(0.0);
    const int64_t kept = components_holding(pca.variances, share);
    for (int64_t k = 0; k < kept; ++k) make_largest_entry_positive(eigen.vectors.col(k));
    pca.components = eigen.vectors.leftCols(kept);
    return pca;
}

}  // namespace kinetome
