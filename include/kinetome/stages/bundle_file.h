// bundles.h5 and bundle_graph.h5: motion bundles and what leads from one to the other (S1), written
// by their stages and read by all who ask for it. Layout in docs/artifacts.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinetome/models/bundle_graph.h"
#include "kinetome/models/bundle_links.h"
#include "kinetome/stages/segment_file.h"
#include "kinetome/store/artifact.h"

namespace kinetome {

/// Bundles of all partitions, numbered through: those of a partition follow each other, first those
/// that have several members.
struct StoredBundles {
    double pose_rate = 0;                 ///< that frames count at
    std::vector<CutClip> clips;           ///< by name; frames at the pose rate
    std::vector<BundleMember> members;    ///< by clip (its number in `clips`) and frame
    std::vector<std::string> partitions;  ///< paths
    std::vector<int32_t> partition_of;    ///< by bundle

    int32_t bundles() const { return static_cast<int32_t>(partition_of.size()); }
    /// Members of each bundle; one: it is degenerate.
    std::vector<int32_t> heights() const;
};

void write_bundles(ArtifactWriter& file, const StoredBundles& bundles);
StoredBundles read_bundles(const ArtifactReader& file);

/// The graph, and the node of each bundle; -1: it is degenerate, and lies on an edge or dangles.
struct StoredBundleGraph {
    BundleGraph bundles;  ///< its nodes linked
    std::vector<int32_t> node_of;
    std::vector<BundleLink> links;  ///< of nodes
};

void write_bundle_graph(ArtifactWriter& file, const StoredBundleGraph& graph);
/// Links them in the graph, too.
void link_nodes(StoredBundleGraph& graph, std::vector<BundleLink> links);
/// The nodes that bundle_graph.h5 names, with the members in bundles.h5.
StoredBundleGraph read_bundle_graph(const ArtifactReader& file, const StoredBundles& bundles);

}  // namespace kinetome
