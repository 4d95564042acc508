// Linear maps from the principal markers to the others, one a leaf of a pose hierarchy (S2 §4,
// Eq. 1), and the whole pose that they estimate.
#pragma once

#include <cstdint>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/packing.h"
#include "kinetome/math/moments.h"
#include "kinetome/models/pose_hierarchy.h"

namespace kinetome {

enum class MarkerMapRule {
    shrinkage,     ///< towards the map of the parent, as the poses of a leaf determine it badly
    least_squares  ///< S2 Eq. 1, of least norm where the poses do not determine it
};

struct MarkerMapOptions {
    MarkerMapRule rule = MarkerMapRule::shrinkage;  ///< how a leaf's map is found
    double parent_weight = 5000;  ///< shrinkage: the parent's map counts as so many poses
    double noise = 5;             ///< shrinkage: mm; where a marker moves less, in a leaf, its map
                                  ///< is the parent's
};

/// What a node tells its children about their maps.
struct MarkerMap {
    MatrixD map;                   ///< p × (f - p): S - S̄ = mapᵀ (s - s̄)
    MatrixD principal_covariance;  ///< p × p, cm², of s
};

void pack(Packer& out, const MarkerMap& map);
void unpack(Unpacker& in, MarkerMap& map);

/// The map of the poses with these moments (f); `parent`: the node's above, null at the root.
/// With a = the principal values of n poses, b = the others, both about their means, κ =
/// parent_weight and P = the parent's covariance, shrinkage takes
///   (aᵀa + W)⁻¹ (aᵀb + W map of the parent),   W = κ P + (n + κ) noise² I;
/// at the root W = noise² I, against a map of 0.
MarkerMap fit_marker_map(const Moments& poses, const std::vector<int32_t>& principal_columns,
                         const MarkerMap* parent, const MarkerMapOptions& options);

/// Maps of all leaves of a hierarchy.
struct MarkerMaps {
    std::vector<int32_t> estimated_columns;  ///< f - p, ascending: all that are not principal
    std::vector<MatrixD> maps;               ///< C maps, p × (f - p)
};

void pack(Packer& out, const MarkerMaps& maps);
void unpack(Unpacker& in, MarkerMaps& maps);

/// All columns that are not principal.
std::vector<int32_t> estimated_columns(int64_t columns,
                                       const std::vector<int32_t>& principal_columns);

/// The pose (f, cm) that principal values tell: they themselves, and what the maps of the leaves
/// near them estimate, blended by soft_leaves(band).
VectorD estimate_pose(const PoseHierarchy& hierarchy, const MarkerMaps& maps,
                      const VectorD& principal, double band);

/// The band that estimates are blended in unless told otherwise, half gaps: removes most of the
/// jump where the leaf changes.
inline constexpr double default_blend_band = 0.6;

}  // namespace kinetome
