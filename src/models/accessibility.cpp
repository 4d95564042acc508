#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "kinetome/base/parallel.h"
#include "kinetome/models/pose_clusters.h"

namespace kinetome {

namespace {

/// Letters compared with one letter at a time; their means stay in the first-level cache.
constexpr int64_t block_letters = 128;

/// Rounding may differ between the vectorised sums and letter_distance by less than this share;
/// closer calls are left to letter_distance, so that A and Eq. 2 never disagree.
constexpr double close_call = 1e-9;

/// |μ_a - μ_b|² for the letters [first, first + count); `means_by_axis` is D × κ.
std::array<double, block_letters> squared_distances(const MatrixD& means_by_axis, int64_t a,
                                                    int64_t first, int64_t count) {
    std::array<double, block_letters> squared{};
    for (Eigen::Index axis = 0; axis < means_by_axis.rows(); ++axis) {
        const double* const row = means_by_axis.data() + axis * means_by_axis.cols();
        const double here = row[a];
        for (int64_t i = 0; i < count; ++i) {
            const double difference = row[first + i] - here;
            squared[static_cast<size_t>(i)] += difference * difference;
        }
    }
    return squared;
}

}  // namespace

double letter_distance(const Mixture& mixture, int32_t a, int32_t b) {
    double squared = 0;
    for (Eigen::Index axis = 0; axis < mixture.dimension(); ++axis) {
        const double difference = mixture.means(b, axis) - mixture.means(a, axis);
        squared += difference * difference;
    }
    if (squared == 0) return 0;
    return std::sqrt(squared / std::min(mixture.variances[a], mixture.variances[b]));
}

AccessibilityMatrix::AccessibilityMatrix(int64_t letters)
    : letters_(letters),
      words_per_row_((letters + bits_per_word - 1) / bits_per_word),
      words_(static_cast<size_t>(letters * words_per_row_)) {
    for (int32_t a = 0; a < letters; ++a) set_in_row(a, a);
}

AccessibilityMatrix::AccessibilityMatrix(int64_t letters, std::vector<uint64_t> words)
    : letters_(letters),
      words_per_row_((letters + bits_per_word - 1) / bits_per_word),
      words_(std::move(words)) {
    if (static_cast<int64_t>(words_.size()) != letters_ * words_per_row_)
        throw std::invalid_argument(
            "the words of an accessibility matrix and its letters disagree");
}

void AccessibilityMatrix::set(int32_t a, int32_t b) {
    set_in_row(a, b);
    set_in_row(b, a);
}

int64_t AccessibilityMatrix::count() const {
    int64_t ones = 0;
    for (const uint64_t word : words_) ones += std::popcount(word);
    return ones;
}

AccessibilityMatrix accessibility(const Mixture& mixture, double tau, int threads) {
    const int64_t letters = mixture.clusters();
    AccessibilityMatrix matrix(letters);
    const MatrixD means_by_axis = mixture.means.transpose();

    // Each thread writes whole rows of its own; both (a, b) and (b, a) come to the same answer
    // because letter_distance is symmetric.
    parallel_for(threads, (letters + block_letters - 1) / block_letters, [&](int64_t block) {
        const auto first_row = static_cast<int32_t>(block * block_letters);
        const auto end_row = static_cast<int32_t>(std::min(first_row + block_letters, letters));
        for (int64_t first = 0; first < letters; first += block_letters) {
            const int64_t count = std::min(block_letters, letters - first);
            for (int32_t a = first_row; a < end_row; ++a) {
                const auto squared = squared_distances(means_by_axis, a, first, count);
                for (int64_t i = 0; i < count; ++i) {
                    const auto b = static_cast<int32_t>(first + i);
                    const double least = std::min(mixture.variances[a], mixture.variances[b]);
                    const double limit = tau * tau * least;
                    const double value = squared[static_cast<size_t>(i)];
                    if (value > limit * (1 + close_call)) continue;
                    if (value < limit * (1 - close_call) || letter_distance(mixture, a, b) <= tau)
                        matrix.set_in_row(a, b);
                }
            }
        }
    });
    return matrix;
}

void pack(Packer& out, const AccessibilityMatrix& matrix) {
    out.put(matrix.letters());
    pack(out, matrix.words());
}

void unpack(Unpacker& in, AccessibilityMatrix& matrix) {
    matrix = AccessibilityMatrix(in.get<int64_t>());
    unpack(in, matrix.words_);
}

}  // namespace kinetome
