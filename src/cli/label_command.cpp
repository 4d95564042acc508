#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "checks.h"
#include "clip_list.h"
#include "command.h"
#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/stages/label_rows.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/stored_labels.h"
#include "write_text.h"

namespace kinetome::cli {
namespace {

struct LabelFlags {
    std::filesystem::path store, from, truth, output;
    std::vector<std::string> known_takes;
    LabelTransferOptions transfer;
    std::string format = "csv", generation = "current";
};

/// What becomes of the labels: a table, and a line that sums it up.
struct LabelAnswer {
    Table table;
    std::string summary = {};
};

std::string summary_of(const TransferredLabels& labels) {
    const auto known = std::ranges::count(labels.is_known, true);
    const auto transferred = std::ranges::count_if(
        labels.guesses, [](const LabelGuess& guess) { return guess.label >= 0; });
    const auto all = std::ssize(labels.primitives);
    return fmt::format("{} primitives: {} had a label, {} were given one, {} have none\n", all,
                       known, transferred, all - known - transferred);
}

LabelAnswer answer(const LabelFlags& flags, int threads) {
    if (!flags.known_takes.empty() && (flags.truth.empty() || !flags.from.empty()))
        throw UsageError("--known-takes: expected beside --truth, without --from");
    const OpenStore open(flags.store, flags.generation);
    const Catalog& catalog = open.generation.catalog();
    std::vector<ClipPrimitive> primitives = stored_primitives(open, flags.from);
    const PrimitiveFeatures features = read_primitive_features(open.generation);
    const bool any_known = std::any_of(primitives.begin(), primitives.end(),
                                       [](const auto& one) { return !one.label.empty(); });
    if (!flags.truth.empty() && !any_known) {
        return {label_tables(features, primitives, read_label_rows(flags.truth, catalog),
                             listed_clips(flags.known_takes, catalog), flags.transfer, threads)};
    }
    if (!any_known && !flags.from.empty()) {
        throw Error(ExitCode::nothing_usable,
                    fmt::format("{}: none of its rows meets a primitive of the store: are its "
                                "clips those of `kinetome export {} primitives`, and its frames "
                                "those of the source?",
                                path_for_message(flags.from.string()),
                                path_for_message(flags.store.string())));
    }
    if (!any_known) {
        throw UsageError(fmt::format(
            "no primitive has a label yet: give some with --from FILE, or put them in {} "
            "(clip,first,end,label; frames of the source)",
            (flags.store / "labels.csv").string()));
    }
    const TransferredLabels labels =
        transfer_labels(features, std::move(primitives), flags.transfer, threads);
    if (flags.truth.empty()) return {label_rows(labels), summary_of(labels)};
    return {label_score(labels, read_label_rows(flags.truth, catalog))};
}

}  // namespace

Command label_command() {
    return {"label", "transfer labels to the primitives that have none",
            "kinetome label motion.store --from labels.csv -o labelled.csv",
            [](CLI::App& app) -> Run {
                auto flags = std::make_shared<LabelFlags>();
                app.add_option("STORE", flags->store, "store to read")->required();
                app.add_option("--from", flags->from,
                               "labels: clip,first,end,label (default: STORE/labels.csv)");
                app.add_option("--truth", flags->truth,
                               "annotation: print precision and recall instead; without labels, of "
                               "transferring from all other annotated takes to each");
                app.add_option("--known-takes", flags->known_takes,
                               "with --truth alone: also from the first of these takes, the first "
                               "two, …, separated by commas");
                app.add_option("--threshold", flags->transfer.threshold,
                               "mean distance along a path to a label, cm, at most")
                    ->check(above_zero())
                    ->capture_default_str();
                app.add_option("--lead", flags->transfer.lead,
                               "a label is given if it costs less than this share of any other")
                    ->check(CLI::Range(0.01, 1.0))
                    ->capture_default_str();
                app.add_option("--recognised", flags->transfer.recognised,
                               "where every movement has a label: learn both limits from the "
                               "labelled primitives, so that this share of them would be "
                               "recognised by other takes (1: do not)")
                    ->check(CLI::Range(0.01, 1.0))
                    ->capture_default_str();
                app.add_option("--format", flags->format, "csv or json")->capture_default_str();
                app.add_option("-o,--output", flags->output,
                               "file to write (default: standard output)");
                app.add_option("--generation", flags->generation,
                               "id, the beginning of one, or current");
                return [=](const Invocation& invocation) {
                    const TableFormat format = parse_table_format(flags->format);
                    const LabelAnswer given = answer(*flags, invocation.resources().threads);
                    write_text(flags->output, write_table(given.table, format));
                    if (!flags->output.empty()) fmt::print("{}", given.summary);
                    return ExitCode::success;
                };
            }};
}

}  // namespace kinetome::cli
