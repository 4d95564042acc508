#include "kinetome/stages/bundle_file.h"

#include <map>

#include "kinetome/store/catalog.h"

namespace kinetome {
namespace {

DatasetSpec spec(const char* path, ElementType type, const char* units, const char* description,
                 const char* source = "") {
    return {std::string("/") + path, type, {}, units, description, source, "", {}};
}

std::vector<int64_t> frames_of(const std::vector<CutClip>& clips) {
    std::vector<int64_t> frames;
    for (const CutClip& clip : clips) frames.push_back(clip.frames);
    return frames;
}

}  // namespace

std::vector<int32_t> StoredBundles::heights() const {
    std::vector<int32_t> heights(partition_of.size());
    for (const BundleMember& member : members) ++heights[static_cast<size_t>(member.bundle)];
    return heights;
}

void write_bundles(ArtifactWriter& file, const StoredBundles& bundles) {
    write_cut_clips(file, bundles.clips, "pose rate");
    file.write<double>(
        spec("pose_rate", ElementType::float64, "frames/s", "rate that frames count at"),
        std::span(&bundles.pose_rate, 1));
    file.write_texts(spec("partitions/path", ElementType::text, "1",
                          "takes whose letters are shared: a group of motion_strings.h5"),
                     bundles.partitions);
    file.write<int32_t>(spec("bundles/partition", ElementType::int32, "1",
                             "partition that the bundle was found in", "S1 §3.3"),
                        bundles.partition_of);
    file.write<int32_t>(spec("bundles/height", ElementType::int32, "1",
                             "B_h: members; one in a degenerate bundle", "S1 §3.3"),
                        bundles.heights());
    std::vector<int64_t> clips;
    std::vector<int32_t> numbers, firsts, ends;
    for (const BundleMember& member : bundles.members) {
        numbers.push_back(member.bundle);
        clips.push_back(clip_id(bundles.clips[static_cast<size_t>(member.frames.clip)].name));
        firsts.push_back(static_cast<int32_t>(member.frames.first));
        ends.push_back(static_cast<int32_t>(member.frames.end));
    }
    file.write<int32_t>(spec("members/bundle", ElementType::int32, "1", "bundle", "S1 §3.3"),
                        numbers);
    file.write<int64_t>(spec("members/clip", ElementType::int64, "1", "clip id", "S1 §3.3"), clips);
    file.write<int32_t>(spec("members/first_frame", ElementType::int32, "frames",
                             "first frame in its clip, at the pose rate", "S1 Eq. 6"),
                        firsts);
    file.write<int32_t>(
        spec("members/end_frame", ElementType::int32, "frames", "end, exclusive", "S1 Eq. 6"),
        ends);
}

StoredBundles read_bundles(const ArtifactReader& file) {
    StoredBundles bundles;
    bundles.clips = read_cut_clips(file);
    bundles.pose_rate = file.read<double>("/pose_rate").at(0);
    bundles.partitions = file.read_texts("/partitions/path");
    bundles.partition_of = file.read<int32_t>("/bundles/partition");
    std::map<int64_t, int32_t> number_of;  // by clip id
    for (size_t i = 0; i < bundles.clips.size(); ++i)
        number_of[clip_id(bundles.clips[i].name)] = static_cast<int32_t>(i);
    const auto numbers = file.read<int32_t>("/members/bundle");
    const auto clips = file.read<int64_t>("/members/clip");
    const auto firsts = file.read<int32_t>("/members/first_frame");
    const auto ends = file.read<int32_t>("/members/end_frame");
    for (size_t i = 0; i < numbers.size(); ++i) {
        bundles.members.push_back({numbers[i], {number_of.at(clips[i]), firsts[i], ends[i]}});
    }
    return bundles;
}

void write_bundle_graph(ArtifactWriter& file, const StoredBundleGraph& stored) {
    const MotionGraph& graph = stored.bundles.graph;
    const StrongComponents components = strong_components(graph);
    std::vector<int32_t> heights, from, to;
    std::vector<double> widths;
    std::vector<int64_t> successions, transition_frames;
    for (int32_t node = 0; node < graph.nodes(); ++node) {
        heights.push_back(static_cast<int32_t>(graph.members(node).size()));
        widths.push_back(graph.mean_frames(node));
        const auto targets = graph.targets(node);
        for (size_t edge = 0; edge < targets.size(); ++edge) {
            from.push_back(node);
            to.push_back(targets[edge]);
            const auto all = graph.successions(node, static_cast<int64_t>(edge));
            successions.push_back(static_cast<int64_t>(all.size()));
            transition_frames.push_back(0);
            for (const Succession& one : all) transition_frames.back() += graph.gap(one);
        }
    }
    file.write<int32_t>(spec("bundles/node", ElementType::int32, "1",
                             "node that the bundle is in; -1: degenerate", "S1 §4"),
                        stored.node_of);
    file.write<int32_t>(
        spec("nodes/height", ElementType::int32, "1", "members of its bundles", "S1 §3.3"),
        heights);
    file.write<double>(spec("nodes/mean_frames", ElementType::float64, "frames",
                            "their mean length, at the pose rate", "S1 §3.3"),
                       widths);
    file.write<int32_t>(spec("nodes/component", ElementType::int32, "1",
                             "strongly connected component, numbered by their lowest nodes"),
                        components.component_of);
    file.write<int32_t>(spec("edges/from", ElementType::int32, "1", "node", "S1 §4"), from);
    file.write<int32_t>(spec("edges/to", ElementType::int32, "1", "node", "S1 §4"), to);
    file.write<int64_t>(spec("edges/successions", ElementType::int64, "1",
                             "pairs of members that follow each other", "S1 §4"),
                        successions);
    file.write<int64_t>(spec("edges/transition_frames", ElementType::int64, "frames",
                             "between those pairs, all together", "S1 §4"),
                        transition_frames);
    std::vector<int32_t> first, second;
    std::vector<double> costs;
    for (const BundleLink& link : stored.links) {
        first.push_back(link.first);
        second.push_back(link.second);
        costs.push_back(link.cost);
    }
    file.write<int32_t>(spec("links/first", ElementType::int32, "1",
                             "node that holds the same motion as another, of another body"),
                        first);
    file.write<int32_t>(spec("links/second", ElementType::int32, "1", "that node"), second);
    file.write<double>(spec("links/cost", ElementType::float64, "1",
                            "how far apart they are, of what is linked at most"),
                       costs);
    const BundleGraphFrames& frames = stored.bundles.frames;
    file.write<int64_t>(
        spec("frames/in_nodes", ElementType::int64, "frames", "of members", "S1 §4"),
        std::span(&frames.in_nodes, 1));
    file.write<int64_t>(
        spec("frames/in_edges", ElementType::int64, "frames", "of transitions", "S1 §4"),
        std::span(&frames.in_edges, 1));
    file.write<int64_t>(
        spec("frames/dangling", ElementType::int64, "frames",
             "before the first and after the last member of a clip, and of clips without any"),
        std::span(&frames.dangling, 1));
}

void link_nodes(StoredBundleGraph& graph, std::vector<BundleLink> links) {
    std::vector<NodeLink> nodes;
    for (const BundleLink& link : links) nodes.push_back({link.first, link.second});
    graph.bundles.graph.link(nodes);
    graph.links = std::move(links);
}

StoredBundleGraph read_bundle_graph(const ArtifactReader& file, const StoredBundles& bundles) {
    StoredBundleGraph stored;
    stored.node_of = file.read<int32_t>("/bundles/node");
    stored.bundles =
        bundle_graph(bundles.members, stored.node_of,
                     static_cast<int32_t>(file.rows("/nodes/height")), frames_of(bundles.clips));
    const auto first = file.read<int32_t>("/links/first");
    const auto second = file.read<int32_t>("/links/second");
    const auto costs = file.read<double>("/links/cost");
    std::vector<BundleLink> links;
    for (size_t i = 0; i < first.size(); ++i) links.push_back({first[i], second[i], costs[i]});
    link_nodes(stored, std::move(links));
    return stored;
}

}  // namespace kinetome
