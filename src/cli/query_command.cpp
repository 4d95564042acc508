#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "command.h"
#include "frame_range.h"
#include "kinetome/stages/bundle_query.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/signature_query.h"
#include "write_text.h"

namespace kinetome::cli {
namespace {

struct QueryFlags {
    std::filesystem::path store, output, labels;
    std::string bundle, frames, rule = "pace", format = "csv", generation = "current";
    SignatureQuery query;
};

MatchRule parse_rule(const std::string& name) {
    if (name == "pace") return MatchRule::pace;
    if (name == "repeats") return MatchRule::repeats;
    if (name == "edit") return MatchRule::edit;
    throw UsageError(fmt::format("--match-rule {}: expected pace, repeats or edit", name));
}

ExitCode answer(const QueryFlags& flags, const Invocation& invocation) {
    SignatureQuery query = flags.query;
    if (!query.clip.empty() + !query.file.empty() + !flags.bundle.empty() != 1) {
        throw UsageError(
            "give one of --clip, a clip of the store, --file, a take, and --bundle, a motion "
            "bundle of the store");
    }
    if (!flags.bundle.empty() && !flags.frames.empty()) {
        throw UsageError("--frames: a bundle is looked for as a whole");
    }
    if (query.answers < 1) throw UsageError(fmt::format("-k {}: at least 1", query.answers));
    if (!(query.search.match.tolerance >= 0)) {
        throw UsageError(fmt::format("--match-tolerance {}: at least 0, which means equal leaves",
                                     query.search.match.tolerance));
    }
    query.search.match.rule = parse_rule(flags.rule);
    if (!flags.frames.empty()) query.frames = parse_frame_range(flags.frames);
    const TableFormat format = parse_table_format(flags.format);
    const OpenStore open(flags.store, flags.generation);
    const int threads = invocation.resources().threads;
    const Table table = flags.bundle.empty()
                            ? query_table(open.generation, query, threads)
                            : bundle_query_table(open, flags.bundle, flags.labels, query, threads);
    write_text(flags.output, write_table(table, format));
    return ExitCode::success;
}

}  // namespace

Command query_command() {
    return {"query", "find the sub-motions of a store that are most like one",
            "kinetome query motion.store --clip 02_01 --frames 120:360 -k 10 --rerank",
            [](CLI::App& app) -> Run {
                auto flags = std::make_shared<QueryFlags>();
                SignatureQuery& query = flags->query;
                app.add_option("STORE", flags->store, "store to read")->required();
                app.add_option("--clip", query.clip, "clip of the store to look for");
                app.add_option("--file", query.file, "take to look for, in the store or not");
                app.add_option("--bundle", flags->bundle,
                               "motion bundle of the store to look for, a number or a label: where "
                               "motion like its members is beside them");
                app.add_option("--labels", flags->labels,
                               "of members of bundles: clip,first,end,label (default: "
                               "STORE/labels.csv)");
                app.add_option("--frames", flags->frames,
                               "A:B, its frames from A to before B (default: all)");
                app.add_option("-k", query.answers, "most answers")->capture_default_str();
                app.add_option(
                    "--match-tolerance", query.search.match.tolerance,
                    "most that an answer may differ, mm per marker; 0: the same leaves in "
                    "the same order (default: any)");
                app.add_option("--match-rule", flags->rule,
                               "pace: at most twice as fast or slow; repeats, edit: leaf by leaf, "
                               "however long each lasts")
                    ->capture_default_str();
                app.add_flag("--rerank", query.rerank,
                             "put answers in the order of dynamic time warping of the markers");
                app.add_option("--format", flags->format, "csv or json")->capture_default_str();
                app.add_option("-o,--output", flags->output,
                               "file to write (default: standard output)");
                app.add_option("--generation", flags->generation,
                               "id, the beginning of one, or current");
                return [=](const Invocation& invocation) { return answer(*flags, invocation); };
            }};
}

}  // namespace kinetome::cli
