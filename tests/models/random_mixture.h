// Mixtures to measure distances on.
#pragma once

#include <cstdint>
#include <vector>

#include "kinetome/base/random.h"
#include "kinetome/math/mixture.h"

/// Means of standard normal coordinates, standard deviations between 0.5 and 2.
inline kinetome::Mixture random_mixture(int64_t clusters, int64_t dimension, uint64_t seed) {
    kinetome::RandomStream random(seed, "random_mixture");
    kinetome::Mixture mixture;
    mixture.means.resize(clusters, dimension);
    mixture.variances.resize(clusters);
    mixture.weights = kinetome::VectorD::Constant(clusters, 1.0 / static_cast<double>(clusters));
    for (int64_t k = 0; k < clusters; ++k) {
        for (int64_t d = 0; d < dimension; ++d) mixture.means(k, d) = random.normal();
        const double deviation = random.uniform(0.5, 2);
        mixture.variances[k] = deviation * deviation;
    }
    return mixture;
}

/// Clusters on a line.
inline kinetome::Mixture mixture_on_line(const std::vector<double>& means,
                                         const std::vector<double>& deviations) {
    const auto clusters = static_cast<int64_t>(means.size());
    kinetome::Mixture mixture = random_mixture(clusters, 1, 0);
    for (size_t k = 0; k < means.size(); ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        mixture.means(row, 0) = means[k];
        mixture.variances[row] = deviations[k] * deviations[k];
    }
    return mixture;
}
