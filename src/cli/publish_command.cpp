#include "command.h"
#include "kinetome/stages/reindex.h"
#include "print_summary.h"

namespace kinetome::cli {

Command publish_command() {
    return {
        "publish", "check what the run in progress has complete and make it the current generation",
        "kinetome publish motion.store", [](CLI::App& app) -> Run {
            auto store = std::make_shared<std::filesystem::path>();
            auto copy = std::make_shared<bool>(false);
            app.add_option("STORE", *store, "store with a run in progress")->required();
            app.add_flag("--copy", *copy,
                         "copy unchanged files into the new generation instead of linking them");
            return [=](const Invocation& invocation) {
                invocation.require_joined();
                const RunSummary summary =
                    publish(*store, invocation.resources(), *copy, invocation.log);
                print_summary(summary);
                return exit_code_of(summary);
            };
        }};
}

}  // namespace kinetome::cli
