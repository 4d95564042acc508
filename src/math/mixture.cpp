#include "kinetome/math/mixture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace kinetome {

void merge(MixtureSums& left, const MixtureSums& right) {
    if (left.offset.rows() != right.offset.rows() || left.offset.cols() != right.offset.cols()) {
        throw std::invalid_argument("sums of mixtures of different shapes cannot be added");
    }
    left.rows += right.rows;
    left.log_likelihood += right.log_likelihood;
    left.responsibility += right.responsibility;
    left.offset += right.offset;
    left.squared += right.squared;
}

namespace {

/// New mean and variance of one cluster. The offset is small beside the spread, so that
/// E|y - μ|² - |offset|² keeps its digits.
void estimate_cluster(const MixtureSums& sums, int64_t cluster, double least_variance,
                      Mixture& model) {
    const double responsibility = sums.responsibility[cluster];
    const auto dimension = static_cast<double>(model.dimension());
    double moved = 0;
    for (int64_t j = 0; j < model.dimension(); ++j) {
        const double offset = sums.offset(cluster, j) / responsibility;
        model.means(cluster, j) += offset;
        moved += offset * offset;
    }
    const double variance = (sums.squared[cluster] / responsibility - moved) / dimension;
    model.variances[cluster] = std::max(variance, least_variance);
}

}  // namespace

Mixture estimate(const Mixture& model, const MixtureSums& sums, double least_variance) {
    // Responsibilities below what a weight can hold carry no information on the mean either.
    constexpr double least_weight = std::numeric_limits<double>::min();
    Mixture next = model;
    double total = 0;
    for (int64_t k = 0; k < model.clusters(); ++k) total += sums.responsibility[k];
    if (!(total > 0)) throw std::invalid_argument("a mixture cannot be estimated from no rows");
    for (int64_t k = 0; k < model.clusters(); ++k) {
        const double weight = sums.responsibility[k] / total;
        next.weights[k] = std::max(weight, least_weight);
        if (weight > least_weight) {
            estimate_cluster(sums, k, least_variance, next);
        } else {
            next.variances[k] = least_variance;
        }
    }
    return next;
}

double least_variance(const Moments& moments, const MixtureOptions& options) {
    const auto count = static_cast<double>(moments.count);
    double variance_sum = 0, largest_square = 0;
    for (int64_t j = 0; j < moments.dimension(); ++j) {
        const double variance = moments.scatter(j, j) / count;
        variance_sum += variance;
        largest_square = std::max(largest_square, moments.mean[j] * moments.mean[j] + variance);
    }
    const double share =
        options.variance_floor * variance_sum / static_cast<double>(moments.dimension());
    constexpr double resolution = std::numeric_limits<float>::epsilon() / 2;
    // All rows zero: any positive number whose inverse a float can hold.
    constexpr double tiny = 1e-30;
    return std::max({share, largest_square * resolution * resolution, tiny});
}

double bayesian_information(const MixtureFit& fit, int64_t rows) {
    const auto n = static_cast<double>(rows);
    const auto parameters =
        static_cast<double>(fit.model.clusters() * (fit.model.dimension() + 2) - 1);
    return parameters * std::log(n) - 2 * n * fit.mean_log_likelihood;
}

}  // namespace kinetome
