#include "print_summary.h"

#include <fmt/format.h>

#include "kinetome/base/error.h"

namespace kinetome::cli {
namespace {

constexpr size_t most_reasons = 20;

double mebibytes(uint64_t bytes) {
    return static_cast<double>(bytes) / (1 << 20);
}

void print_quarantined(const Catalog& catalog) {
    size_t shown = 0;
    for (const CatalogClip& clip : catalog.clips) {
        if (clip.indexed()) continue;
        if (++shown <= most_reasons) fmt::print("quarantined: {}\n", clip.quarantined);
    }
    if (shown > most_reasons) {
        fmt::print("quarantined: and {} more; `kinetome export STORE clips` lists all\n",
                   shown - most_reasons);
    }
}

}  // namespace

void print_summary(const RunSummary& summary) {
    const Publication& published = summary.publication;
    print_quarantined(published.catalog);
    fmt::print("{:<16} {:>5} {:>7} {:>9} {:>9} {:>11} {:>11}\n", "stage", "made", "reused",
               "wall s", "cpu s", "peak MiB", "files MiB");
    for (const StageSummary& stage : summary.stages) {
        fmt::print("{:<16} {:>5} {:>7} {:>9.2f} {:>9.2f} {:>11.1f} {:>11.1f}\n", stage.name,
                   stage.made, stage.reused, stage.cost.seconds, stage.cost.cpu_seconds,
                   mebibytes(stage.cost.peak_bytes), mebibytes(stage.bytes));
    }
    fmt::print("{:<16} {:>5} {:>7} {:>9.2f} {:>9.2f} {:>11.1f}\n", "whole run", "", "",
               summary.cost.seconds, summary.cost.cpu_seconds, mebibytes(summary.cost.peak_bytes));
    fmt::print(
        "clips: {} indexed ({} new, {} changed, {} reused), {} quarantined, {} removed; "
        "{} frames\n",
        published.catalog.indexed(), published.added, published.changed, published.reused,
        published.catalog.quarantined(), published.catalog.removed.size(),
        published.catalog.frames());
    if (published.generation.empty()) {
        fmt::print("not published: `kinetome publish STORE` makes it visible\n");
        return;
    }
    fmt::print("generation {}{}\n", published.generation,
               published.up_to_date ? " (up to date: nothing changed)" : "");
}

ExitCode exit_code_of(const RunSummary& summary) {
    return summary.publication.catalog.quarantined() ? ExitCode::some_quarantined
                                                     : ExitCode::success;
}

}  // namespace kinetome::cli
