#include "kinetome/stages/pose_hierarchy_file.h"

#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "group_writer.h"

namespace kinetome {
namespace {

std::span<const double> values_of(const MatrixD& matrix) {
    return {matrix.data(), static_cast<size_t>(matrix.size())};
}

void write_principal(const GroupWriter& out, const ClassHierarchy& model) {
    const PrincipalMarkers& principal = model.principal;
    out.texts("markers/name", "marker names, three columns each", "S2 §3", model.marker_names);
    out.values("principal/markers", "1", "principal markers, by number", "S2 §3",
               principal.markers);
    out.values("principal/columns", "1", "their coordinates that move, by column", "S2 §3",
               principal.columns);
    out.values("principal/components", "1", "principal components that reach the tolerance",
               "S2 §3", std::vector<int64_t>{principal.components});
    out.values("principal/start", "1", "start of k-means that the set was found from", "",
               std::vector<int32_t>{principal.start});
    out.values("principal/residual", "mm per marker",
               "RMS of a linear estimate of the other markers from these", "",
               std::vector<double>{principal.residual});
}

void write_nodes(const GroupWriter& out, const PoseHierarchy& hierarchy) {
    const auto column = [&](auto HierarchyNode::*member) {
        std::vector<std::decay_t<decltype(HierarchyNode{}.*member)>> values;
        for (const HierarchyNode& node : hierarchy.nodes) values.push_back(node.*member);
        return values;
    };
    out.values("nodes/parent", "1", "node above; -1: the root", "S2 §4",
               column(&HierarchyNode::parent));
    out.values("nodes/below", "1", "child on the plane's negative side; -1: a leaf", "S2 §4",
               column(&HierarchyNode::below));
    out.values("nodes/above", "1", "child on the plane's positive side; -1: a leaf", "S2 §4",
               column(&HierarchyNode::above));
    out.values("nodes/leaf", "1", "number among the leaves; -1: split", "S2 §4",
               column(&HierarchyNode::leaf));
    out.values("nodes/rows", "frames", "poses it was made of, copies included", "S2 §4",
               column(&HierarchyNode::rows));
    out.values("nodes/offset", "cm", "of the plane: normal · s = offset", "S2 §4",
               column(&HierarchyNode::offset));
    out.values("nodes/half_gap", "cm", "half the distance between the centroids it parts", "S2 §4",
               column(&HierarchyNode::half_gap));
    out.rows("nodes/normal", "1", "of the plane, unit length; 0 at leaves", "S2 §4",
             {hierarchy.normals.cols()}, values_of(hierarchy.normals));
}

void write_leaves(const GroupWriter& out, const PoseHierarchy& hierarchy, const MarkerMaps& maps) {
    out.rows("leaves/mean", "cm", "mean pose of each leaf", "S2 §5.1", {hierarchy.columns()},
             values_of(hierarchy.means));
    out.rows("leaves/basis", "1", "principal components of each leaf, one a column", "S2 §5.1",
             {hierarchy.columns(), hierarchy.dimension()}, values_of(hierarchy.bases));
    out.values("leaves/error", "mm per marker", "RMS over the poses a leaf was made of", "S2 §4",
               hierarchy.leaf_errors);
    const auto known = static_cast<int64_t>(hierarchy.principal_columns.size());
    const auto others = static_cast<int64_t>(maps.estimated_columns.size());
    std::vector<double> all;
    all.reserve(maps.maps.size() * static_cast<size_t>(known * others));
    for (const MatrixD& map : maps.maps) {
        const auto values = values_of(map);
        all.insert(all.end(), values.begin(), values.end());
    }
    out.rows("leaves/map", "1", "S - mean = mapᵀ (s - mean): other columns from principal ones",
             "S2 Eq. 1", {known, others}, all);
    out.values("tolerance", "mm per marker", "that the leaves were to keep", "S2 §4",
               std::vector<double>{hierarchy.tolerance});
}

VectorD read_vector(const ArtifactReader& file, const std::string& path) {
    const auto values = file.read<double>(path);
    return Eigen::Map<const VectorD>(values.data(), static_cast<Eigen::Index>(values.size()));
}

template <class T>
void read_column(const ArtifactReader& file, const std::string& path,
                 std::vector<HierarchyNode>& nodes, T HierarchyNode::*member) {
    const auto values = file.read<T>(path);
    nodes.resize(values.size());
    for (size_t i = 0; i < values.size(); ++i) nodes[i].*member = values[i];
}

PoseHierarchy read_hierarchy(const ArtifactReader& file, const std::string& group) {
    PoseHierarchy hierarchy;
    hierarchy.principal_columns = file.read<int32_t>(group + "/principal/columns");
    auto& nodes = hierarchy.nodes;
    read_column(file, group + "/nodes/parent", nodes, &HierarchyNode::parent);
    read_column(file, group + "/nodes/below", nodes, &HierarchyNode::below);
    read_column(file, group + "/nodes/above", nodes, &HierarchyNode::above);
    read_column(file, group + "/nodes/leaf", nodes, &HierarchyNode::leaf);
    read_column(file, group + "/nodes/rows", nodes, &HierarchyNode::rows);
    read_column(file, group + "/nodes/offset", nodes, &HierarchyNode::offset);
    read_column(file, group + "/nodes/half_gap", nodes, &HierarchyNode::half_gap);
    hierarchy.normals.resize(static_cast<int64_t>(nodes.size()), 0);
    if (file.contains(group + "/nodes/normal")) {
        hierarchy.normals = file.read_matrix_double(group + "/nodes/normal");
    }
    hierarchy.means = file.read_matrix_double(group + "/leaves/mean");
    const MatrixD bases = file.read_matrix_double(group + "/leaves/basis");
    const int64_t dimension = file.spec(group + "/leaves/basis").row_shape.at(1);
    hierarchy.bases = Eigen::Map<const MatrixD>(bases.data(), bases.size() / dimension, dimension);
    hierarchy.leaf_errors = read_vector(file, group + "/leaves/error");
    hierarchy.tolerance = file.read<double>(group + "/tolerance").at(0);
    return hierarchy;
}

MarkerMaps read_maps(const ArtifactReader& file, const std::string& group,
                     const PoseHierarchy& hierarchy) {
    MarkerMaps maps;
    maps.estimated_columns = estimated_columns(hierarchy.columns(), hierarchy.principal_columns);
    const auto known = static_cast<int64_t>(hierarchy.principal_columns.size());
    const auto others = static_cast<int64_t>(maps.estimated_columns.size());
    maps.maps.assign(static_cast<size_t>(hierarchy.leaves()), MatrixD(known, others));
    if (!file.contains(group + "/leaves/map")) return maps;
    for (int64_t leaf = 0; leaf < hierarchy.leaves(); ++leaf) {
        const auto values = file.read<double>(group + "/leaves/map", leaf, 1);
        maps.maps[static_cast<size_t>(leaf)] =
            Eigen::Map<const MatrixD>(values.data(), known, others);
    }
    return maps;
}

}  // namespace

void write_pose_hierarchy(ArtifactWriter& file, const std::string& group,
                          const ClassHierarchy& model) {
    const GroupWriter out(file, group);
    write_principal(out, model);
    write_nodes(out, model.hierarchy);
    write_leaves(out, model.hierarchy, model.maps);
    out.values("pose_rate", "frames/s", "rate of the poses it was made of", "",
               std::vector<double>{model.pose_rate});
}

ClassHierarchy read_pose_hierarchy(const ArtifactReader& file, const std::string& group) {
    ClassHierarchy model;
    model.principal.markers = file.read<int32_t>(group + "/principal/markers");
    model.principal.columns = file.read<int32_t>(group + "/principal/columns");
    model.principal.components = file.read<int64_t>(group + "/principal/components").at(0);
    model.principal.start = file.read<int32_t>(group + "/principal/start").at(0);
    model.principal.residual = file.read<double>(group + "/principal/residual").at(0);
    model.marker_names = file.read_texts(group + "/markers/name");
    model.hierarchy = read_hierarchy(file, group);
    model.maps = read_maps(file, group, model.hierarchy);
    model.pose_rate = file.read<double>(group + "/pose_rate").at(0);
    return model;
}

std::vector<std::string> hierarchy_classes(const ArtifactReader& file) {
    std::set<std::string> classes;
    for (const DatasetSpec& dataset : file.datasets()) {
        classes.insert(dataset.path.substr(1, dataset.path.find('/', 1) - 1));
    }
    return {classes.begin(), classes.end()};
}

}  // namespace kinetome
