// The piecewise-linear pose model (S2 §4): a decision tree over the principal markers whose leaves
// are local linear models. Poses are normalised markers (features/markers.h), in cm.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/packing.h"

namespace kinetome {

/// Marker positions a pose is compared by: all but the origin marker, which is where it is put.
int64_t compared_markers(int64_t columns);

/// A node of the tree. Node 0 is the root; children have higher numbers than their parent.
struct HierarchyNode {
    static constexpr int32_t none = -1;

    int32_t parent = none;
    int32_t below = none;  ///< child on the plane's negative side; none: this is a leaf
    int32_t above = none;  ///< child on the plane's positive side
    int32_t leaf = none;   ///< its number among the leaves; none: this is split
    int64_t rows = 0;      ///< poses it was made of, copies included
    double offset = 0;     ///< of the plane: normal · s = offset
    double half_gap = 0;   ///< cm, half the distance between the centroids that the plane parts

    bool is_leaf() const { return leaf != none; }
};

/// f columns, p of them principal, C leaves of dimension d. Leaves are numbered in node order.
struct PoseHierarchy {
    std::vector<int32_t> principal_columns;  ///< p, ascending
    std::vector<HierarchyNode> nodes;        ///< 2 C - 1
    MatrixD normals;                         ///< nodes × p, unit length; 0 at leaves
    MatrixD means;                           ///< C × f, cm
    MatrixD bases;        ///< C f × d: rows [c f, (c + 1) f) are leaf c's principal components, as
                          ///< orthonormal columns, largest variance first, then columns of zeros
                          ///< where its poses vary in fewer directions
    VectorD leaf_errors;  ///< C, mm per marker, RMS over the poses the leaf was made of
    double tolerance = 0;  ///< mm per marker that the leaves were to keep

    int64_t columns() const { return means.cols(); }
    int64_t leaves() const { return means.rows(); }
    int64_t dimension() const { return bases.cols(); }
    /// f × d.
    auto basis(int32_t leaf) const { return bases.middleRows(leaf * columns(), columns()); }
};

void pack(Packer& out, const PoseHierarchy& hierarchy);
void unpack(Unpacker& in, PoseHierarchy& hierarchy);

/// The principal values of a pose (f), in the order of principal_columns.
VectorD principal_values(const PoseHierarchy& hierarchy, std::span<const float> pose);

/// normal · s - offset at a node that is split: positive above its plane, cm.
double distance_above(const PoseHierarchy& hierarchy, int32_t node, const VectorD& principal);

/// The leaf that principal values fall in; on a plane: below.
int32_t leaf_of(const PoseHierarchy& hierarchy, const VectorD& principal);
/// The same of a whole pose (f).
int32_t leaf_of(const PoseHierarchy& hierarchy, std::span<const float> pose);
/// The same of many poses (n × f). Throws std::invalid_argument for another number of columns.
std::vector<int32_t> leaves_of(const PoseHierarchy& hierarchy, const MatrixFView& poses);

/// A leaf's part in a pose.
struct LeafWeight {
    int32_t leaf = 0;
    double weight = 0;  ///< (0, 1]; those of a pose sum to 1

    bool operator==(const LeafWeight&) const = default;
};

/// The leaves that a pose near planes belongs to, by leaf: at each plane the weight passes linearly
/// from one side to the other within `band` half gaps of it, so that what is blended by these
/// weights is continuous in the pose. band 0: the leaf of leaf_of alone.
std::vector<LeafWeight> soft_leaves(const PoseHierarchy& hierarchy, const VectorD& principal,
                                    double band);

/// RMS over markers between the mean poses of two leaves, mm per marker.
double leaf_distance(const PoseHierarchy& hierarchy, int32_t a, int32_t b);

/// A pose as seen from a leaf: its d coordinates along the leaf's basis, cm.
VectorD leaf_coordinates(const PoseHierarchy& hierarchy, int32_t leaf, std::span<const float> pose);
/// And back: mean + basis · coordinates (f), cm.
VectorD pose_at(const PoseHierarchy& hierarchy, int32_t leaf, const VectorD& coordinates);

/// Error between a pose and its reconstruction, mm per marker: the root of the mean over the
/// compared markers of the squared distance.
double pose_error(std::span<const float> pose, const VectorD& reconstructed);

/// Of every pose (n × f) what the leaf that it falls in leaves of it, mm per marker; `leaves` are
/// those of leaves_of().
std::vector<double> leaf_errors(const PoseHierarchy& hierarchy, const MatrixFView& poses,
                                std::span<const int32_t> leaves);

}  // namespace kinetome
