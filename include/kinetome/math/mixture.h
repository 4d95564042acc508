// Mixture of isotropic Gaussians fitted by EM (S1 §3.2), as accumulate / merge / estimate: sums of
// pieces can be made anywhere and added in the fixed tree; only estimation changes the model.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/matrix.h"
#include "kinetome/base/packing.h"
#include "kinetome/base/stop.h"
#include "kinetome/math/moments.h"
#include "kinetome/math/row_source.h"

namespace kinetome {

/// κ clusters in d dimensions.
struct Mixture {
    MatrixD means;      ///< κ × d
    VectorD variances;  ///< κ, one a cluster (σ²), the same in every direction
    VectorD weights;    ///< κ, sum 1

    int64_t clusters() const { return means.rows(); }
    int64_t dimension() const { return means.cols(); }
};

/// Sufficient statistics of one E step. Moments are about the means of the model that made them,
/// so that the variance needs no difference of large numbers.
struct MixtureSums {
    int64_t rows = 0;
    double log_likelihood = 0;  ///< Σ ln p(y), nats
    VectorD responsibility;     ///< κ, Σ r
    MatrixD offset;             ///< κ × d, Σ r (y - μ)
    VectorD squared;            ///< κ, Σ r |y - μ|²

    double mean_log_likelihood() const { return log_likelihood / static_cast<double>(rows); }
};

struct MixtureOptions {
    int max_iterations = 60;       ///< EM iterations at most
    double min_gain = 1e-4;        ///< stop when the mean log-likelihood gains less (nats)
    double variance_floor = 1e-4;  ///< least σ², as a share of the mean per-dimension variance
    uint64_t seed = 1;             ///< of the k-means++ start
    int restarts = 1;              ///< starts; the one of highest likelihood is kept
    int64_t start_sample = 2'000'000;  ///< rows the start is drawn from, at most (evenly spaced)
};

struct MixtureFit {
    Mixture model;
    double mean_log_likelihood = 0;  ///< of `model` itself, nats a row (one E step after the last)
    std::vector<double> history;     ///< mean log-likelihood before each estimate
    bool converged = false;          ///< the gain fell below min_gain, not the iterations ran out
};

/// What fit_mixture hands out after every iteration: enough to go on from there.
struct MixtureProgress {
    int restart = 0;
    int iteration = 0;               ///< iterations done in this restart
    double mean_log_likelihood = 0;  ///< of the model before this iteration's estimate
    std::vector<double> history;     ///< mean log-likelihood, one an iteration of this restart
    bool converged = false;
    Mixture model;    ///< after this iteration's estimate
    MixtureFit best;  ///< of earlier restarts; without clusters in the first
};

/// E step over the rows (n × d): blocks of float32 products, sums in double, in the layout's fixed
/// tree, the same at every rank; no memory in n × κ. Throws std::invalid_argument when a value is
/// not finite, naming its row, when a variance or weight is not positive, and when shapes differ.
MixtureSums accumulate(const Mixture& model, const RowSource& rows, const Workers& workers);
void merge(MixtureSums& left, const MixtureSums& right);

/// M step. A cluster without responsibility keeps its mean and takes the floor's variance and the
/// least positive weight (the smallest normal number: its share of a row is then nil, so that the
/// likelihood of the others does not fall); `least_variance` is absolute.
Mixture estimate(const Mixture& model, const MixtureSums& sums, double least_variance);

/// k-means++ (Arthur & Vassilvitskii 2007): exact D² sampling, equal weights; the equal variances
/// are the mean of D² per dimension that the last draw leaves, no less than the floor.
/// Throws std::invalid_argument when there are fewer rows than clusters. Rows that coincide may
/// leave fewer distinct means than κ: the result then has that many clusters.
/// Ranks share the rows drawn from; each holds its part of them in memory (start_bytes).
Mixture start_mixture(const RowSource& rows, int64_t clusters, const MixtureOptions& options,
                      int restart, const Workers& workers);

/// Memory that the start of a fit takes at each of `ranks` ranks.
uint64_t start_bytes(int64_t rows, int64_t columns, const MixtureOptions& options, int ranks);

/// The absolute floor of the variances: the option's share of the mean per-dimension variance, and
/// never less than what the rounding of the values to float makes of a point.
double least_variance(const Moments& moments, const MixtureOptions& options);

/// The whole fit. `report` is called after every iteration (for checkpoints and logs); give
/// `resume_from` what it last received to go on as if nothing had happened, bit for bit.
/// Stops with Interrupted between iterations. Every rank reports and returns the same.
MixtureFit fit_mixture(const RowSource& rows, int64_t clusters, const MixtureOptions& options,
                       const Workers& workers, const StopToken& stop = {},
                       const std::function<void(const MixtureProgress&)>& report = {},
                       const MixtureProgress* resume_from = nullptr);

/// The cluster under which each row is likeliest, *without* the mixing weight ("maximises its
/// likelihood", S1 §3.2); ties to the lowest cluster. n, the same at every rank.
std::vector<int32_t> likeliest_clusters(const Mixture& model, const RowSource& rows,
                                        const Workers& workers);

/// Bayesian information criterion of a fit, lower is better: κ(d + 2) - 1 parameters.
double bayesian_information(const MixtureFit& fit, int64_t rows);

void pack(Packer& out, const Mixture& mixture);
void unpack(Unpacker& in, Mixture& mixture);
void pack(Packer& out, const MixtureSums& sums);
void unpack(Unpacker& in, MixtureSums& sums);
void pack(Packer& out, const MixtureFit& fit);
void unpack(Unpacker& in, MixtureFit& fit);
void pack(Packer& out, const MixtureProgress& progress);
void unpack(Unpacker& in, MixtureProgress& progress);

}  // namespace kinetome
