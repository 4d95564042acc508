#include "command.h"
#include "kinetome/stages/reindex.h"
#include "print_summary.h"

namespace kinetome::cli {

Command reindex_command() {
    return {
        .name = "reindex",
        .summary = "index a folder of takes: everything, incrementally, and publish (the main job)",
        .example = "kinetome reindex takes/ --store motion.store --threads 8",
        .set_up = [](CLI::App& app) -> Run {
            auto request = std::make_shared<ReindexRequest>();
            auto flags = std::make_shared<ReindexFlags>(app);
            auto node_scratch = add_node_scratch(app);
            auto only = std::make_shared<std::vector<std::string>>();
            app.add_option("CORPUS", request->corpus, "folder of takes")->required();
            app.add_option("--store", request->store, "store to write to")->required();
            app.add_option("--only", *only, "stages to bring up to date, separated by commas")
                ->delimiter(',');
            app.add_flag("--copy", request->copy,
                         "copy unchanged files into the new generation instead of linking them");
            app.add_flag("--join", request->join,
                         "go on with the run that `kinetome plan --open` opened");
            app.add_flag("!--no-publish", request->publish,
                         "leave the publication to `kinetome publish`");
            return [=](const Invocation& invocation) {
                invocation.require_joined();
                request->resources = invocation.resources();
                request->resources.node_scratch = require_node_scratch(*node_scratch);
                take_options(*flags, *request);
                request->only = {only->begin(), only->end()};
                request->ranks = &invocation.ranks;
                const RunSummary summary = reindex(*request, invocation.log, invocation.stop);
                if (invocation.ranks.is_root()) print_summary(summary);
                return exit_code_of(summary);
            };
        },
        .uses_ranks = true};
}

}  // namespace kinetome::cli
