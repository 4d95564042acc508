// Pose clusters (S1 §3.2): PCA of pose vectors and a mixture of isotropic Gaussians, one letter a
// cluster; accessibility between letters (Eq. 1, Eq. 2).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/base/stop.h"
#include "kinetome/math/mixture.h"
#include "kinetome/math/pca.h"

namespace kinetome {

enum class ClusterCountRule { given, ratio, bic };

struct PoseClusterOptions {
    double variance_share = 0.70;        ///< variance the principal components keep (S1: 70 %)
    ClusterCountRule count_rule = ClusterCountRule::ratio;  ///< how κ is chosen
    int64_t clusters = 0;                ///< κ when given
    double frames_per_cluster = 25;      ///< ratio: κ = n / this …
    int64_t least_clusters = 30;         ///< … at least this …
    int64_t most_clusters = 8000;        ///< … at most this
    std::vector<int64_t> bic_clusters;   ///< κ to try when chosen by BIC
    MixtureOptions mixture;
};

/// κ for n frames: given, or clamp(n / frames_per_cluster, least, most); never above n.
int64_t cluster_count(const PoseClusterOptions& options, int64_t frames);

/// d(a, b) = |μ_b - μ_a| / min(σ_a, σ_b)                                             (S1 Eq. 1)
double letter_distance(const Mixture& mixture, int32_t a, int32_t b);

/// κ × κ bits, row by row; symmetric with a unit diagonal.
class AccessibilityMatrix {
  public:
    AccessibilityMatrix() = default;
    explicit AccessibilityMatrix(int64_t letters);
    int64_t letters() const { return letters_; }
    int64_t words_per_row() const { return words_per_row_; }
    bool operator()(int32_t a, int32_t b) const;
    void set(int32_t a, int32_t b);  ///< both (a, b) and (b, a)
    /// Number of ones, the diagonal included.
    int64_t count() const;
    const std::vector<uint64_t>& words() const { return words_; }

  private:
    int64_t letters_ = 0;
    int64_t words_per_row_ = 0;
    std::vector<uint64_t> words_;
};

/// A[a, b] = 1 if d(a, b) <= tau                                                     (S1 Eq. 2)
AccessibilityMatrix accessibility(const Mixture& mixture, double tau, int threads);

}  // namespace kinetome
