#include <fmt/format.h>

#include "command.h"
#include "kinetome/stages/aligned_text.h"
#include "kinetome/stages/reindex.h"
#include "kinetome/stages/stored_bundles.h"

namespace kinetome::cli {
namespace {

struct BundlesFlags {
    std::filesystem::path store, labels;
    std::string format = "text", generation = "current";
    bool copy = false;
    std::shared_ptr<ReindexFlags> options;
};

/// Whose options are flags: over the letters that the store has, these make bundles of them.
const std::set<std::string> remade = {"motion_strings", "bundles"};

/// With the options given; nothing without any.
void make_again(const BundlesFlags& flags, const Invocation& invocation) {
    const auto given = flags.options->given();
    if (given.empty()) return;
    if (flags.generation != "current") {
        throw UsageError(
            "--generation is of no use beside options to make bundles with: they are "
            "made in the current one");
    }
    invocation.require_joined();
    remake({.store = flags.store,
            .stages = remade,
            .options = given,
            .resources = invocation.resources(),
            .copy = flags.copy},
           invocation.log, invocation.stop);
}

void print_shares(const BundleShares& shares) {
    const auto share = [&](int64_t frames) {
        return 100 * static_cast<double>(frames) / static_cast<double>(shares.frames.sum());
    };
    fmt::print("frames in bundles      {:>9}  {:5.1f} %\n", shares.frames.in_nodes,
               share(shares.frames.in_nodes));
    fmt::print("frames in transitions  {:>9}  {:5.1f} %\n", shares.frames.in_edges,
               share(shares.frames.in_edges));
    fmt::print("dangling frames        {:>9}  {:5.1f} %\n", shares.frames.dangling,
               share(shares.frames.dangling));
    fmt::print("bundles.h5             {:>9} bytes\n", shares.file_bytes);
}

/// Before bundles are made, which takes long.
void require_list_format(const std::string& format) {
    if (format == "text" || format == "csv" || format == "json") return;
    throw UsageError(fmt::format("--format {}: expected text, csv or json", format));
}

ExitCode list_bundles(const BundlesFlags& flags) {
    const OpenStore open(flags.store, flags.generation);
    const bool as_text = flags.format == "text";
    const Table table = bundle_list(open, flags.labels);
    if (!as_text) {
        fmt::print("{}", write_table(table, parse_table_format(flags.format)));
        return ExitCode::success;
    }
    fmt::print("{}", aligned_text(table));
    print_shares(bundle_shares(open.generation));
    return ExitCode::success;
}

}  // namespace

Command bundles_command() {
    return {
        "bundles",
        "list the motion bundles of a store, and where its frames are; with options, make them "
        "again before",
        "kinetome bundles motion.store --rho 2 --labels cycles.csv", [](CLI::App& app) -> Run {
            auto flags = std::make_shared<BundlesFlags>();
            app.add_option("STORE", flags->store, "store to read")->required();
            app.add_option("--labels", flags->labels,
                           "of members: clip,first,end,label, such as `kinetome label` writes "
                           "(default: STORE/labels.csv)");
            app.add_option("--format", flags->format, "text, csv or json")->capture_default_str();
            app.add_option("--generation", flags->generation,
                           "id, the beginning of one, or current");
            app.add_flag("--copy", flags->copy,
                         "copy unchanged files into a new generation instead of linking them");
            flags->options =
                std::make_shared<ReindexFlags>(app, remade, ReindexFlags::Otherwise::as_stored);
            return [=](const Invocation& invocation) {
                require_list_format(flags->format);
                make_again(*flags, invocation);
                return list_bundles(*flags);
            };
        }};
}

}  // namespace kinetome::cli
