// bundle_graph: which motion bundles follow each other (S1 §4), and which of different subjects are
// the same.
#include "kinetome/stages/bundle_file.h"
#include "kinetome/stages/stage.h"
#include "kinetome/stages/subject_links.h"

namespace kinetome {
namespace {

/// A node for each bundle that has several members.
StoredBundleGraph graph_of(const StoredBundles& bundles) {
    StoredBundleGraph graph;
    int32_t nodes = 0;
    for (const int32_t height : bundles.heights())
        graph.node_of.push_back(height > 1 ? nodes++ : -1);
    std::vector<int64_t> clip_frames;
    for (const CutClip& clip : bundles.clips) clip_frames.push_back(clip.frames);
    graph.bundles = bundle_graph(bundles.members, graph.node_of, nodes, clip_frames);
    return graph;
}

/// The same links by nodes, which are numbered as bundles are.
std::vector<BundleLink> between_nodes(std::vector<BundleLink> links,
                                      const std::vector<int32_t>& node_of) {
    for (BundleLink& link : links) {
        link.first = node_of[static_cast<size_t>(link.first)];
        link.second = node_of[static_cast<size_t>(link.second)];
    }
    return links;
}

}  // namespace

StageResult make_bundle_graph(const StageContext& context, const StageTask& task) {
    const ArtifactReader input = context.workspace.open(*task.inputs_of("bundles").front());
    const StoredBundles bundles = read_bundles(input);
    std::vector<BundleLink> links = link_subjects(context, task.inputs_of("frames"), bundles);
    StageResult result;
    if (!context.is_root()) return result;
    StoredBundleGraph graph = graph_of(bundles);
    link_nodes(graph, between_nodes(std::move(links), graph.node_of));
    ArtifactWriter file(task.output, task.header, context.writing());
    write_bundle_graph(file, graph);
    const BundleGraphFrames& frames = graph.bundles.frames;
    context.log.info(
        "bundle_graph: {} nodes, {} edges, {} links; {} frames in nodes, {} in transitions, {} "
        "dangle",
        graph.bundles.graph.nodes(), graph.bundles.graph.edges(), graph.links.size(),
        frames.in_nodes, frames.in_edges, frames.dangling);
    result.file = file.close();
    return result;
}

}  // namespace kinetome
