// Principal markers (S2 §3): the few markers that tell where the others are, found by principal
// feature analysis.
#pragma once

#include <cstdint>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/packing.h"
#include "kinetome/math/moments.h"

namespace kinetome {

struct PrincipalMarkerOptions {
    double tolerance = 20;  ///< mm per marker that the principal components may leave unexplained
    int starts = 32;        ///< of k-means, each of which makes a set; the best set is kept
    int extra_clusters =
        2;  ///< clusters of features beyond the number of components (S2: slightly)
    double least_deviation = 1;  ///< mm; coordinates that move less belong to no cluster
    uint64_t seed = 1;           ///< of the clustering of features
};

struct PrincipalMarkers {
    std::vector<int32_t> markers;  ///< ascending, of f / 3
    std::vector<int32_t> columns;  ///< their coordinates that move, ascending, of f
    int64_t components = 0;        ///< principal components that reach the tolerance
    int start = 0;                 ///< the one the set was found from
    double residual = 0;  ///< mm per marker, RMS of a linear estimate of the other markers from
                          ///< these over the poses they were chosen by
};

void pack(Packer& out, const PrincipalMarkers& principal);
void unpack(Unpacker& in, PrincipalMarkers& principal);

/// Markers chosen by the moments of poses (f columns, cm): the fewest principal components within
/// the tolerance; their absolute loadings clustered by k-means; a minimal set of markers with a
/// coordinate in every cluster, each time the one in most clusters not yet covered, ties to the one
/// that explains most of a cluster's variance. The clusters depend on where k-means starts, and
/// take left and right for the same: of several starts the set is kept that a linear estimate of
/// the other markers leaves the least residual of, ties to the first.
/// No markers when nothing moves. Throws std::invalid_argument for a value that is not finite,
/// naming its column, and unless columns come in threes.
PrincipalMarkers select_principal_markers(const Moments& poses,
                                          const PrincipalMarkerOptions& options);

}  // namespace kinetome
