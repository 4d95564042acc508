#include <fmt/format.h>

#include "command.h"
#include "kinetome/stages/reindex.h"

namespace kinetome::cli {

Command ingest_command() {
    return {"ingest", "read takes into the run in progress, all or one slice, without publishing",
            "kinetome ingest takes/ --store motion.store --slice 3/8", [](CLI::App& app) -> Run {
                auto request = std::make_shared<ReindexRequest>();
                auto flags = std::make_shared<ReindexFlags>(app);
                auto node_scratch = add_node_scratch(app);
                auto slice = std::make_shared<std::string>();
                app.add_option("CORPUS", request->corpus, "folder of takes")->required();
                app.add_option("--store", request->store, "store to write to")->required();
                app.add_option("--slice", *slice, "i/n: the i-th of n nearly equal parts");
                app.add_flag("--join", request->join,
                             "take part in the run that `kinetome plan --open` opened");
                return [=](const Invocation& invocation) {
                    request->resources = invocation.resources();
                    request->resources.node_scratch = require_node_scratch(*node_scratch);
                    take_options(*flags, *request);
                    std::optional<Slice> part;
                    if (!slice->empty()) part = parse_slice(*slice);
                    if (!part) invocation.require_joined();  // slices may be tasks of one step
                    const IngestSummary summary =
                        ingest(*request, part, invocation.log, invocation.stop);
                    for (const std::string& reason : summary.reasons) {
                        fmt::print("quarantined: {}\n", reason);
                    }
                    fmt::print(
                        "{} clips read ({} frames), {} quarantined; `kinetome publish {}` "
                        "makes them visible\n",
                        summary.indexed, summary.frames, summary.quarantined,
                        request->store.string());
                    return summary.quarantined ? ExitCode::some_quarantined : ExitCode::success;
                };
            }};
}

}  // namespace kinetome::cli
