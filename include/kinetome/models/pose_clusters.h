// Pose clusters (S1 §3.2): a mixture of isotropic Gaussians over projected pose vectors, one letter
// a cluster; accessibility between letters (Eq. 1, Eq. 2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/stop.h"
#include "kinetome/math/mixture.h"

namespace kinetome {

enum class ClusterCountRule { ratio, bic };

struct PoseClusterOptions {
    double variance_share = 0.70;  ///< variance the principal components keep (S1: 70 %)
    int64_t clusters = 0;          ///< κ; 0: chosen by count_rule
    ClusterCountRule count_rule = ClusterCountRule::ratio;  ///< how κ is chosen
    double frames_per_cluster = 25;                         ///< ratio: κ = n / this …
    int64_t least_clusters = 30;                            ///< … at least this …
    int64_t most_clusters = 8000;                           ///< … at most this
    std::vector<int64_t> bic_clusters;                      ///< κ to try when chosen by BIC
    MixtureOptions mixture;
};

/// The κ to fit to n frames, never above n: the one given, or clamp(n / frames_per_cluster, least,
/// most), or each of bic_clusters once, in the order listed. Empty when there are no frames. Throws
/// std::invalid_argument when the options name no positive κ.
std::vector<int64_t> cluster_counts(const PoseClusterOptions& options, int64_t frames);

/// The largest of cluster_counts, 0 without frames: what the memory and time of a fit go by.
int64_t cluster_count(const PoseClusterOptions& options, int64_t frames);

/// One κ that was fitted on the way to the best (lower is better).
struct TriedClusterCount {
    int64_t clusters = 0;
    double bayesian_information = 0;
};

struct PoseClusters {
    MixtureFit fit;
    std::vector<TriedClusterCount> tried;  ///< every κ fitted, in the order of cluster_counts

    int64_t clusters() const { return fit.model.clusters(); }
};

/// What fit_pose_clusters hands out after every iteration: enough to go on from there.
struct PoseClusterProgress {
    size_t candidate = 0;     ///< index into cluster_counts of the κ being fitted
    MixtureProgress mixture;  ///< how far its fit is
    PoseClusters best;        ///< of the candidates before it; tried is empty in the first
};

void pack(Packer& out, const PoseClusters& clusters);
void unpack(Unpacker& in, PoseClusters& clusters);
void pack(Packer& out, const PoseClusterProgress& progress);
void unpack(Unpacker& in, PoseClusterProgress& progress);

/// Memory that fitting n × D rows in so many pieces takes at each rank beside the rows themselves:
/// the start's sample, and the sums of pieces at work, or waiting for their sibling, or on their
/// way between ranks.
uint64_t fitting_bytes(int64_t rows, int64_t columns, int64_t pieces,
                       const PoseClusterOptions& options, int threads, int rank_count);

/// Fits the mixture to projected pose vectors (n × D) for every κ of cluster_counts and keeps the
/// one of lowest Bayesian information criterion, ties to the first. `report` is called after every
/// iteration; give `resume_from` what it last received to go on as if nothing had happened, bit
/// for bit. Stops with Interrupted between iterations. Every rank reports and returns the same.
/// Throws std::invalid_argument without frames.
PoseClusters fit_pose_clusters(const RowSource& rows, const PoseClusterOptions& options,
                               const Workers& workers, const StopToken& stop = {},
                               const std::function<void(const PoseClusterProgress&)>& report = {},
                               const PoseClusterProgress* resume_from = nullptr);

/// d(a, b) = |μ_b - μ_a| / min(σ_a, σ_b); 0 where the means coincide                  (S1 Eq. 1)
double letter_distance(const Mixture& mixture, int32_t a, int32_t b);

/// κ × κ bits, row by row; symmetric with a unit diagonal.
class AccessibilityMatrix {
  public:
    AccessibilityMatrix() = default;
    /// Every letter accessible from itself alone.
    explicit AccessibilityMatrix(int64_t letters);
    /// What words() of a matrix of so many letters was. Throws std::invalid_argument when their
    /// number disagrees.
    AccessibilityMatrix(int64_t letters, std::vector<uint64_t> words);

    int64_t letters() const { return letters_; }
    int64_t words_per_row() const { return words_per_row_; }
    bool operator()(int32_t a, int32_t b) const {
        return (words_[word_of(a, b)] >> (b % bits_per_word)) & 1U;
    }
    void set(int32_t a, int32_t b);  ///< both (a, b) and (b, a)
    /// Number of ones, the diagonal included.
    int64_t count() const;
    /// letters × words_per_row; bit b % 64 of word b / 64 of row a is A[a, b].
    const std::vector<uint64_t>& words() const { return words_; }

    bool operator==(const AccessibilityMatrix&) const = default;

  private:
    friend AccessibilityMatrix accessibility(const Mixture&, double, int);
    friend void unpack(Unpacker&, AccessibilityMatrix&);

    static constexpr int32_t bits_per_word = 64;
    size_t word_of(int32_t a, int32_t b) const {
        return static_cast<size_t>(a * words_per_row_ + b / bits_per_word);
    }
    void set_in_row(int32_t a, int32_t b) {
        words_[word_of(a, b)] |= uint64_t{1} << (b % bits_per_word);
    }

    int64_t letters_ = 0;
    int64_t words_per_row_ = 0;
    std::vector<uint64_t> words_;
};

void pack(Packer& out, const AccessibilityMatrix& matrix);
void unpack(Unpacker& in, AccessibilityMatrix& matrix);

/// A[a, b] = 1 if d(a, b) <= tau                                                     (S1 Eq. 2)
AccessibilityMatrix accessibility(const Mixture& mixture, double tau, int threads);

}  // namespace kinetome
