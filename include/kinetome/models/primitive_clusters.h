// Clusters of primitives (S3 §4): the components of a graph that joins primitives which a warping
// path of little cost matches. Their number is not given.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/corpus_primitive.h"

namespace kinetome {

/// Distances are those of the features (cm).
struct PrimitiveClusterOptions {
    double threshold = 56;       ///< mean cost of a path that joins two primitives, at most
    double radius = 72;          ///< no such path leads through frames farther apart: it lies in
                                 ///< their neighbourhood graph
    double share_across = 0.75;  ///< of the pairs between two clusters of different clips: so many
                                 ///< must be joined for the clusters to be one
};

/// The cluster of each primitive, numbered from 0 as they appear. Two primitives are joined if the
/// warping path of slope 1/2 to 2 between them (warp.h: slope_limited_steps, WarpWeight::both),
/// which may slip one frame at each end, has a mean cost within the threshold. The clusters of a
/// clip are the components of its primitives. Those of a corpus are the components of the clips'
/// clusters, which are joined where at least the share of the pairs between them is: among many
/// primitives single pairs form chains from one movement to another. With a share of 0 a single
/// pair suffices, and the clusters are the components of all primitives.
///
/// `features` (n × d) are those of a clip or of a corpus. Clusters are those of comparing every
/// pair, for any number of threads; primitives whose first frames are not near each other are never
/// compared. Throws std::invalid_argument for a primitive that is empty or lies outside the
/// features, for a value in one that is not finite, and for options below 0 or a share above 1.
std::vector<int32_t> cluster_primitives(const MatrixFView& features,
                                        std::span<const CorpusPrimitive> primitives,
                                        const PrimitiveClusterOptions& options, int threads);

}  // namespace kinetome
