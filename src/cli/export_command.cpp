#include <fmt/format.h>

#include <cstdio>

#include "command.h"
#include "kinetome/base/file.h"
#include "kinetome/stages/export.h"
#include "kinetome/stages/open_store.h"

namespace kinetome::cli {
namespace {

struct ExportFlags {
    std::filesystem::path store, output;
    std::string what, format = "csv", generation = "current";
};

}  // namespace

Command export_command() {
    return {
        "export", "write a table of a store: clips, letters, segments, primitives, …",
        "kinetome export motion.store letters --format csv -o letters.csv",
        [](CLI::App& app) -> Run {
            auto flags = std::make_shared<ExportFlags>();
            app.add_option("STORE", flags->store, "store to read")->required();
            app.add_option("WHAT", flags->what, "clips, letters, neighbors, segments or primitives")
                ->required();
            app.add_option("--format", flags->format, "csv or json")->capture_default_str();
            app.add_option("-o,--output", flags->output,
                           "file to write (default: standard output)");
            app.add_option("--generation", flags->generation,
                           "id, the beginning of one, or current");
            return [=](const Invocation&) {
                const TableFormat format = parse_table_format(flags->format);
                const OpenStore open(flags->store, flags->generation);
                const std::string text =
                    write_table(export_table(open.generation, flags->what), format);
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
