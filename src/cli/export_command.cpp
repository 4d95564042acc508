#include <fmt/format.h>

#include <cstdio>

#include "command.h"
#include "kinetome/report/timeline_svg.h"
#include "kinetome/stages/export.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/primitive_walk.h"
#include "kinetome/stages/stored_bundles.h"
#include "kinetome/stages/stored_timeline.h"
#include "write_text.h"

namespace kinetome::cli {
namespace {

struct ExportFlags {
    std::filesystem::path store, output, labels;
    std::string what, format, generation = "current";
};

/// --format, or what is usual for the thing exported.
std::string format_of(const ExportFlags& flags, const std::string& usual) {
    return flags.format.empty() ? usual : flags.format;
}

std::string exported(const ExportFlags& flags) {
    if (flags.what == "timeline") {
        if (format_of(flags, "svg") != "svg") {
            throw UsageError("--format " + flags.format + ": a timeline is svg");
        }
        const OpenStore open(flags.store, flags.generation);
        return timeline_svg(stored_timeline(open.generation));
    }
    if (flags.what == "primitive-graph") {
        const GraphFormat format = parse_graph_format(format_of(flags, "csv"));
        const OpenStore open(flags.store, flags.generation);
        return write_graph(stored_graph(stored_primitives(open, flags.labels),
                                        clip_source(open.generation), WalkOptions{}.longest_gap),
                           format);
    }
    if (flags.what == "bundle-graph") {
        const GraphFormat format = parse_graph_format(format_of(flags, "csv"));
        const OpenStore open(flags.store, flags.generation);
        const WalkOptions options = options_of_bundle_walk({});
        StoredGraph graph =
            stored_graph(stored_bundle_members(open, flags.labels), clip_source(open.generation),
                         options.longest_gap, options.style);
        link_clusters(graph, stored_bundle_links(open.generation));
        return write_graph(graph, format);
    }
    const TableFormat format = parse_table_format(format_of(flags, "csv"));
    const OpenStore open(flags.store, flags.generation);
    return write_table(export_table(open, flags.what, flags.labels), format);
}

void export_neighbors(const ExportFlags& flags) {
    const TableFormat format = parse_table_format(format_of(flags, "csv"));
    const OpenStore open(flags.store, flags.generation);
    write_text(flags.output,
               [&](const TakeText& take) { write_neighbors(open.generation, format, take); });
}

}  // namespace

Command export_command() {
    return {
        "export", "write a table of a store: clips, letters, segments, primitives, …",
        "kinetome export motion.store letters --format csv -o letters.csv",
        [](CLI::App& app) -> Run {
            auto flags = std::make_shared<ExportFlags>();
            app.add_option("STORE", flags->store, "store to read")->required();
            app.add_option("WHAT", flags->what,
                           "clips, letters, bundles, bundle-graph, hierarchy, neighbors, segments, "
                           "primitives, primitive-graph, signatures or timeline")
                ->required();
            app.add_option(
                "--format", flags->format,
                "csv or json (default: csv); of graphs dot and svg, too; of a timeline svg");
            app.add_option(
                "--labels", flags->labels,
                "of primitives, bundles and their graphs: clip,first,end,label, such as `kinetome "
                "label` writes (default: STORE/labels.csv)");
            app.add_option("-o,--output", flags->output,
                           "file to write (default: standard output)");
            app.add_option("--generation", flags->generation,
                           "id, the beginning of one, or current");
            return [=](const Invocation&) {
                if (flags->what == "neighbors") {
                    export_neighbors(*flags);
                } else {
                    write_text(flags->output, exported(*flags));
                }
                return ExitCode::success;
            };
        }};
}

}  // namespace kinetome::cli
