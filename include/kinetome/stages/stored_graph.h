// The graph of the primitives of a store (S3 §6.2).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kinetome/formats/annotation.h"
#include "kinetome/formats/clip.h"
#include "kinetome/models/primitive_graph.h"
#include "kinetome/stages/open_store.h"

namespace kinetome {

/// A primitive as a walk needs it; frames at the source's rate, end exclusive.
struct ClipPrimitive {
    std::string clip;
    int64_t first = 0, end = 0;
    int32_t cluster = -1;    ///< -1: like no other
    std::string label = {};  ///< "": not known

    bool operator==(const ClipPrimitive&) const = default;
};

/// What is known of a clip before it is read.
struct ClipKind {
    std::string clip_class;  ///< of its skeleton
    double rate = 120;       ///< frames a second
};

/// Where clips come from; both throw when there is no clip of that name.
struct ClipSource {
    std::function<ClipKind(const std::string& clip)> kind;
    std::function<Clip(const std::string& clip)> read;
};

struct StoredGraph {
    std::vector<ClipPrimitive> primitives;  ///< pieces of the graph, at their sources' rates
    PrimitiveGraph nodes;
    std::vector<std::string> clips;  ///< by number in the graph
    double rate = 0;                 ///< frames a second of the graph's pieces: of most primitives
};

/// Two clusters or bundles that hold the same motion of different bodies, by their numbers.
struct ClusterLink {
    int32_t first = 0, second = 0;
};

/// `longest_gap`: seconds between two primitives of which one follows the other. Throws what
/// source.kind does, and UsageError when there are no primitives.
StoredGraph stored_graph(std::vector<ClipPrimitive> primitives, const ClipSource& source,
                         double longest_gap, const GraphStyle& style = {});

/// Links the nodes of those clusters of which the graph holds both.
void link_clusters(StoredGraph& graph, const std::vector<ClusterLink>& links);

/// Gives each primitive the label that covers most of its frames, of equal ones the first by
/// alphabet, where it covers at least half of them; the others keep theirs. Rows are in frames of
/// the sources.
void label_primitives(std::vector<ClipPrimitive>& primitives, const std::vector<CycleRow>& labels);

/// Labels of a table (read_label_rows): that of the file, or the store's labels.csv where there is
/// one, which may speak of clips that the store has no more. Throws InputError for a table that
/// cannot be read or does not fit.
void label_from_table(std::vector<ClipPrimitive>& primitives, const OpenStore& open,
                      const std::filesystem::path& labels);

/// All primitives of a generation, in the order of clips and frames, labelled (label_from_table).
/// Throws UsageError when the generation has no primitives.
std::vector<ClipPrimitive> stored_primitives(const OpenStore& open,
                                             const std::filesystem::path& labels = {});

/// What the generation tells of its clips, whose frames are read from its shards. It outlives this.
ClipSource clip_source(const Generation& generation);

enum class GraphFormat { csv, json, dot, svg };
/// Throws UsageError for another name.
GraphFormat parse_graph_format(std::string_view name);

/// The adjacency of its nodes, by node, and all that stands for it. CSV: a line a succession of two
/// primitives, `from_node,to_node,from_cluster,to_cluster,from_label,to_label,clip,from_first,
/// from_end,to_first,to_end`; JSON: nodes with their primitives and strong components, edges with
/// their numbers of successions, links of nodes; DOT: the same for Graphviz, links dashed; SVG: a
/// picture (graph_svg). Clusters and primitives are called as the graph's style has it. Frames at
/// the sources' rates.
std::string write_graph(const StoredGraph& graph, GraphFormat format);

}  // namespace kinetome
