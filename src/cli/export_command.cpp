#include <fmt/format.h>

#include <cstdio>

#include "command.h"
#include "kinetome/base/file.h"
#include "kinetome/report/timeline_svg.h"
#include "kinetome/stages/export.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/stored_timeline.h"

namespace kinetome::cli {
namespace {

struct ExportFlags {
    std::filesystem::path store, output;
    std::string what, format, generation = "current";
};

std::string exported(const ExportFlags& flags) {
    const bool is_picture = flags.what == "timeline";
    if (is_picture && !flags.format.empty() && flags.format != "svg") {
        throw UsageError("--format " + flags.format + ": a timeline is svg");
    }
    const TableFormat format =
        parse_table_format(is_picture || flags.format.empty() ? "csv" : flags.format);
    const OpenStore open(flags.store, flags.generation);
    if (is_picture) return timeline_svg(stored_timeline(open.generation));
    return write_table(export_table(open.generation, flags.what), format);
}

}  // namespace

Command export_command() {
    return {"export", "write a table of a store: clips, letters, segments, primitives, …",
            "kinetome export motion.store letters --format csv -o letters.csv",
            [](CLI::App& app) -> Run {
                auto flags = std::make_shared<ExportFlags>();
                app.add_option("STORE", flags->store, "store to read")->required();
                app.add_option("WHAT", flags->what,
                               "clips, letters, neighbors, segments, primitives or timeline")
                    ->required();
                app.add_option("--format", flags->format,
                               "csv or json (default: csv); of a timeline svg");
                app.add_option("-o,--output", flags->output,
                               "file to write (default: standard output)");
                app.add_option("--generation", flags->generation,
                               "id, the beginning of one, or current");
                return [=](const Invocation&) {
                    const std::string text = exported(*flags);
                    if (!flags->output.empty()) {
                        write_file_atomically(flags->output, text);
                    } else {
                        std::fwrite(text.data(), 1, text.size(),
                                    stdout);  // main flushes and checks
                    }
                    return ExitCode::success;
                };
            }};
}

}  // namespace kinetome::cli
