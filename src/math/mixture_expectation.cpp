#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinetome/base/parallel.h"
#include "kinetome/math/mixture.h"
#include "mixture_input.h"

namespace kinetome {
namespace {

double square(double x) {
    return x * x;
}

}  // namespace

MixtureSums accumulate(const Mixture& model, const MatrixFView& rows, const PieceLayout& layout,
                       int threads) {
    require_layout_of(rows, layout);
    require_finite(rows);
    const int64_t clusters = model.clusters(), dimension = model.dimension();
    auto empty = [&] {
        return MixtureSums{0, 0, VectorD::Zero(clusters), MatrixD::Zero(clusters, dimension),
                           VectorD::Zero(clusters)};
    };
    auto piece_sums = [&](const RowRange& piece) {
        MixtureSums sums = empty();
        sums.rows = piece.size();
        VectorD density(clusters), distance(clusters);
        for (int64_t i = piece.first; i < piece.end; ++i) {
            for (int64_t k = 0; k < clusters; ++k) {
                distance[k] = 0;
                for (int64_t j = 0; j < dimension; ++j) {
                    distance[k] += square(double(rows(i, j)) - model.means(k, j));
                }
                density[k] =
                    std::log(model.weights[k]) - distance[k] / (2 * model.variances[k]) -
                    0.5 * double(dimension) * std::log(2 * std::numbers::pi * model.variances[k]);
            }
            const double largest = density.maxCoeff();
            double total = 0;
            for (int64_t k = 0; k < clusters; ++k) total += std::exp(density[k] - largest);
            sums.log_likelihood += largest + std::log(total);
            for (int64_t k = 0; k < clusters; ++k) {
                const double r = std::exp(density[k] - largest) / total;
                sums.responsibility[k] += r;
                sums.squared[k] += r * distance[k];
                for (int64_t j = 0; j < dimension; ++j) {
                    sums.offset(k, j) += r * (double(rows(i, j)) - model.means(k, j));
                }
            }
        }
        return sums;
    };
    auto sums = sum_pieces<MixtureSums>(
        threads, layout, piece_sums,
        [](MixtureSums& left, const MixtureSums& right) { merge(left, right); });
    return sums ? *std::move(sums) : empty();
}

std::vector<int32_t> likeliest_clusters(const Mixture& model, const MatrixFView& rows,
                                        int threads) {
    require_finite(rows);
    std::vector<int32_t> likeliest(static_cast<size_t>(rows.rows()));
    parallel_for(threads, rows.rows(), [&](int64_t i) {
        double best = -std::numeric_limits<double>::infinity();
        for (int64_t k = 0; k < model.clusters(); ++k) {
            double distance = 0;
            for (int64_t j = 0; j < rows.cols(); ++j) {
                distance += square(double(rows(i, j)) - model.means(k, j));
            }
            const double density = -0.5 * (distance / model.variances[k] +
                                           double(rows.cols()) * std::log(model.variances[k]));
            if (density > best) {
                best = density;
                likeliest[size_t(i)] = static_cast<int32_t>(k);
            }
        }
    });
    return likeliest;
}

}  // namespace kinetome
