// Known truth for the mixture's tests: the plain double E step, and rows of several kinds.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "kinetome/base/random.h"
#include "kinetome/math/mixture.h"

namespace kinetome::test {

/// Without Eigen, which sanitizers make slow: tests compare some million pairs.
inline double squared_distance(const MatrixF& a, int64_t row_of_a, const MatrixF& b,
                               int64_t row_of_b) {
    const float* const x = a.data() + row_of_a * a.cols();
    const float* const y = b.data() + row_of_b * b.cols();
    double sum = 0;
    for (int64_t j = 0; j < a.cols(); ++j) {
        const double difference = double(x[j]) - double(y[j]);
        sum += difference * difference;
    }
    return sum;
}

inline double squared_distance(const Mixture& model, int64_t cluster, const MatrixF& rows,
                               int64_t row) {
    double sum = 0;
    for (int64_t j = 0; j < rows.cols(); ++j) {
        const double difference = double(rows(row, j)) - model.means(cluster, j);
        sum += difference * difference;
    }
    return sum;
}

/// ln N(row | cluster), without the mixing weight.
inline double log_density(const Mixture& model, int64_t cluster, const MatrixF& rows, int64_t row) {
    const double variance = model.variances[cluster];
    return -0.5 * squared_distance(model, cluster, rows, row) / variance -
           0.5 * double(rows.cols()) * std::log(2 * std::numbers::pi * variance);
}

inline MixtureSums reference_sums(const Mixture& model, const MatrixF& rows) {
    const int64_t clusters = model.clusters(), dimension = model.dimension();
    MixtureSums sums{rows.rows(), 0, VectorD::Zero(clusters), MatrixD::Zero(clusters, dimension),
                     VectorD::Zero(clusters)};
    std::vector<double> joint(static_cast<size_t>(clusters));
    for (int64_t i = 0; i < rows.rows(); ++i) {
        for (int64_t k = 0; k < clusters; ++k) {
            joint[size_t(k)] = std::log(model.weights[k]) + log_density(model, k, rows, i);
        }
        const double largest = *std::max_element(joint.begin(), joint.end());
        double total = 0;
        for (const double value : joint) total += std::exp(value - largest);
        sums.log_likelihood += largest + std::log(total);
        for (int64_t k = 0; k < clusters; ++k) {
            const double r = std::exp(joint[size_t(k)] - largest) / total;
            sums.responsibility[k] += r;
            sums.squared[k] += r * squared_distance(model, k, rows, i);
            for (int64_t j = 0; j < dimension; ++j) {
                sums.offset(k, j) += r * (double(rows(i, j)) - model.means(k, j));
            }
        }
    }
    return sums;
}

/// Smooth in time, as poses are: a random walk with a pull to the origin.
inline MatrixF wandering_rows(int64_t count, int64_t dimension, uint64_t seed) {
    RandomStream random(seed, "wandering rows");
    MatrixF rows(count, dimension);
    for (int64_t i = 0; i < count; ++i) {
        for (int64_t j = 0; j < dimension; ++j) {
            const double last = i > 0 ? double(rows(i - 1, j)) : random.normal();
            rows(i, j) = static_cast<float>(0.99 * last + 0.14 * random.normal());
        }
    }
    return rows;
}

/// Nothing to do with the row before.
inline MatrixF scattered_rows(int64_t count, int64_t dimension, uint64_t seed) {
    RandomStream random(seed, "scattered rows");
    MatrixF rows(count, dimension);
    for (int64_t i = 0; i < rows.size(); ++i) rows.data()[i] = float(random.normal());
    return rows;
}

/// Means near rows, standard deviations spread over [least, most], uneven weights.
inline Mixture random_mixture(const MatrixF& rows, int64_t clusters, double least, double most,
                              uint64_t seed) {
    RandomStream random(seed, "random mixture");
    Mixture model{MatrixD(clusters, rows.cols()), VectorD(clusters), VectorD(clusters)};
    for (int64_t k = 0; k < clusters; ++k) {
        const auto row = static_cast<int64_t>(random.below(uint64_t(rows.rows())));
        const double deviation = least * std::pow(most / least, random.uniform());
        model.variances[k] = deviation * deviation;
        model.weights[k] = 0.1 + random.uniform();
        for (int64_t j = 0; j < rows.cols(); ++j) {
            model.means(k, j) = double(rows(row, j)) + deviation * random.normal();
        }
    }
    model.weights /= model.weights.sum();
    return model;
}

inline bool same_bits(const Mixture& a, const Mixture& b) {
    return a.means == b.means && a.variances == b.variances && a.weights == b.weights;
}

inline bool same_bits(const MixtureSums& a, const MixtureSums& b) {
    return a.rows == b.rows && a.log_likelihood == b.log_likelihood &&
           a.responsibility == b.responsibility && a.offset == b.offset && a.squared == b.squared;
}

}  // namespace kinetome::test
