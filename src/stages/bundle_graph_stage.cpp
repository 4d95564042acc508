// bundle_graph: which motion bundles follow each other (S1 §4).
#include "kinetome/stages/bundle_file.h"
#include "kinetome/stages/stage.h"

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

}  // namespace

StageResult make_bundle_graph(const StageContext& context, const StageTask& task) {
    StageResult result;
    if (!context.is_root()) return result;
    const ArtifactReader input = context.workspace.open(*task.inputs_of("bundles").front());
    const StoredBundleGraph graph = graph_of(read_bundles(input));
    ArtifactWriter file(task.output, task.header, context.writing());
    write_bundle_graph(file, graph);
    const BundleGraphFrames& frames = graph.bundles.frames;
    context.log.info(
        "bundle_graph: {} nodes, {} edges; {} frames in nodes, {} in transitions, {} dangle",
        graph.bundles.graph.nodes(), graph.bundles.graph.edges(), frames.in_nodes, frames.in_edges,
        frames.dangling);
    result.file = file.close();
    return result;
}

}  // namespace kinetome
