#include "mixture_start.h"

#include <optional>
#include <stdexcept>
#include <string>

#include "kinetome/base/random.h"
#include "mixture_input.h"
#include "start_sample.h"

namespace kinetome {
namespace {

/// The sample, shared by ranks in whole blocks. All calls are made by all ranks together.
class SharedSample {
  public:
    SharedSample(const RowSource& rows, int64_t count, const Workers& workers)
        : workers_(workers),
          block_count_((count + sample_block_rows - 1) / sample_block_rows),
          sample_(rows, count, {first_block(workers.rank()), first_block(workers.rank() + 1)},
                  workers.threads) {}

    std::vector<float> row(int64_t index) const {
        return from_owner(index / sample_block_rows, [&](int64_t block) {
            return sample_.row(block * sample_block_rows + index % sample_block_rows);
        });
    }

    void add_centre(const std::vector<float>& centre) {
        sample_.add_centre(centre);
        weights_ = sample_.block_weights();
        if (workers_.rank_count() == 1) return;
        const auto parts = workers_.ranks->gather_to_all(packed(weights_));
        weights_.clear();
        for (const std::string& part : parts) {
            const auto weights = unpacked<std::vector<double>>(part);
            weights_.insert(weights_.end(), weights.begin(), weights.end());
        }
    }

    /// Σ of squared distances to the nearest centre, blocks in order. Throws std::invalid_argument
    /// where a squared distance is more than a float can hold.
    double total_weight() const {
        double total = 0;
        for (const double weight : weights_) total += weight;
        if (std::isinf(total)) {
            throw std::invalid_argument("the rows are too far apart to square distances");
        }
        return total;
    }

    /// The row at `target` in [0, total_weight()), rows laid end to end by their squared distance.
    std::vector<float> row_at(double target) const {
        const auto block = static_cast<int64_t>(entry_holding<double>(weights_, target));
        return from_owner(block, [&](int64_t mine) { return sample_.row_at(mine, target); });
    }

  private:
    int64_t first_block(int rank) const { return block_count_ * rank / workers_.rank_count(); }

    /// find(block, counted from the owner's first), brought to all by the rank that holds the
    /// block.
    template <class Find>
    std::vector<float> from_owner(int64_t block, Find&& find) const {
        const int64_t first = first_block(workers_.rank());
        std::vector<float> found;
        if (block >= first && block < first_block(workers_.rank() + 1)) found = find(block - first);
        if (workers_.rank_count() == 1) return found;
        for (const std::string& part : workers_.ranks->gather_to_all(packed(found))) {
            auto row = unpacked<std::vector<float>>(part);
            if (!row.empty()) return row;
        }
        throw std::logic_error("no rank holds a block of the start's sample");
    }

    const Workers& workers_;
    int64_t block_count_;
    StartSample sample_;
    std::vector<double> weights_;  ///< of all blocks
};

int64_t sample_size(int64_t rows, int64_t clusters, const MixtureOptions& options) {
    return std::min(rows, std::max(options.start_sample, clusters));
}

/// The j-th draw of a restart has a stream of its own, so that a start can be redone alone.
RandomStream draw_stream(uint64_t seed, int restart, int64_t draw) {
    constexpr uint64_t draws_per_restart = uint64_t{1} << 32;
    return {seed, "k-means++",
            static_cast<uint64_t>(restart) * draws_per_restart + static_cast<uint64_t>(draw)};
}

Mixture equal_clusters(const std::vector<std::vector<float>>& centres, double variance) {
    const auto count = static_cast<int64_t>(centres.size());
    const auto dimension = static_cast<int64_t>(centres.front().size());
    Mixture mixture{MatrixD(count, dimension), VectorD::Constant(count, variance),
                    VectorD::Constant(count, 1.0 / static_cast<double>(count))};
    for (int64_t k = 0; k < count; ++k) {
        for (int64_t j = 0; j < dimension; ++j) {
            mixture.means(k, j) = double(centres[size_t(k)][size_t(j)]);
        }
    }
    return mixture;
}

}  // namespace

double checked_least_variance(const RowSource& rows, const MixtureOptions& options,
                              const Workers& workers) {
    const Moments moments = moments_of(rows, workers);
    require_finite(rows, moments);
    return least_variance(moments, options);
}

Mixture start_mixture(const RowSource& rows, int64_t clusters, const MixtureOptions& options,
                      double least_variance, int restart, const Workers& workers) {
    if (clusters < 1 || rows.rows() < clusters || rows.columns() < 1) {
        throw std::invalid_argument(std::to_string(clusters) + " clusters cannot be started from " +
                                    std::to_string(rows.rows()) + " rows of " +
                                    std::to_string(rows.columns()) + " columns");
    }
    const int64_t count = sample_size(rows.rows(), clusters, options);
    SharedSample sample(rows, count, workers);
    const auto first = draw_stream(options.seed, restart, 0).below(static_cast<uint64_t>(count));
    std::vector<std::vector<float>> centres{sample.row(static_cast<int64_t>(first))};
    sample.add_centre(centres.back());
    for (int64_t draw = 1; draw < clusters; ++draw) {
        const double total = sample.total_weight();
        if (!(total > 0)) break;
        const double target = draw_stream(options.seed, restart, draw).uniform() * total;
        centres.push_back(sample.row_at(target));
        sample.add_centre(centres.back());
    }
    const double left =
        sample.total_weight() / static_cast<double>(count) / static_cast<double>(rows.columns());
    return equal_clusters(centres, std::max(left, least_variance));
}

Mixture start_mixture(const RowSource& rows, int64_t clusters, const MixtureOptions& options,
                      int restart, const Workers& workers) {
    return start_mixture(rows, clusters, options, checked_least_variance(rows, options, workers),
                         restart, workers);
}

uint64_t start_bytes(int64_t rows, int64_t columns, const MixtureOptions& options, int ranks) {
    const int64_t count = sample_size(rows, 1, options);
    // Values and squared distance of each row, a ball around every 16 of them.
    const int64_t bytes_per_row = 4 * (columns + 1) + (4 * columns + 20) / fan_out + 1;
    return static_cast<uint64_t>(count * bytes_per_row / ranks);
}

}  // namespace kinetome
