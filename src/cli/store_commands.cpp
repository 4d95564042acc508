// Commands that look at a store or tidy it: info, verify, gc, diff.
#include <fmt/format.h>

#include <map>
#include <set>

#include "checks.h"
#include "command.h"
#include "kinetome/base/quote.h"
#include "kinetome/stages/comparison.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/stage.h"
#include "kinetome/stages/verification.h"

namespace kinetome::cli {
namespace {

namespace fs = std::filesystem;

double mebibytes(uint64_t bytes) {
    return static_cast<double>(bytes) / (1 << 20);
}

void print_clips(const Catalog& catalog) {
    fmt::print("corpus      {}\nclips       {} indexed, {} quarantined, {} frames\n",
               catalog.corpus, catalog.indexed(), catalog.quarantined(), catalog.frames());
    std::map<std::string, std::pair<int64_t, int64_t>> classes;
    size_t warned = 0;
    for (const CatalogClip& clip : catalog.clips) {
        warned += !clip.warnings.empty();
        if (!clip.indexed()) continue;
        ++classes[clip.clip_class].first;
        classes[clip.clip_class].second += clip.frames;
    }
    for (const auto& [name, counts] : classes) {
        fmt::print("class       {}: {} clips, {} frames\n", name, counts.first, counts.second);
    }
    if (warned) fmt::print("warnings    {} clips, see catalog.json\n", warned);
}

void print_stages(const Ledger& ledger) {
    fmt::print("{:<16} {:>6} {:>10} {:>10} {:>10}\n", "stage", "files", "MiB", "wall s",
               "peak MiB");
    for (const StageRow& stage : stage_table()) {
        const auto receipts = ledger.of_stage(stage.name);
        if (receipts.empty()) {
            fmt::print("{:<16} {:>6}\n", stage.name, "-");
            continue;
        }
        uint64_t bytes = 0, peak = 0;
        double seconds = 0;
        for (const Receipt* receipt : receipts) {
            bytes += receipt->file.bytes;
            seconds += receipt->cost.seconds;
            peak = std::max(peak, receipt->cost.peak_bytes);
        }
        fmt::print("{:<16} {:>6} {:>10.1f} {:>10.2f} {:>10.1f}\n", stage.name, receipts.size(),
                   mebibytes(bytes), seconds, mebibytes(peak));
    }
}

void print_lines(const char* title, const std::vector<std::string>& lines) {
    if (lines.empty()) return;
    fmt::print("{}:\n", title);
    for (const std::string& line : lines) fmt::print("  {}\n", path_for_message(line));
}

/// STORE and --generation, of commands that read one generation.
struct GenerationFlags {
    fs::path store;
    std::string generation = "current";
    void add_to(CLI::App& app) {
        app.add_option("STORE", store, "store to read")->required();
        app.add_option("--generation", generation, "id, the beginning of one, or current");
    }
};

}  // namespace

Command info_command() {
    return {"info", "tell what a store holds", "kinetome info motion.store",
            [](CLI::App& app) -> Run {
                auto flags = std::make_shared<GenerationFlags>();
                flags->add_to(app);
                return [=](const Invocation&) {
                    const OpenStore open(flags->store, flags->generation);
                    const auto ids = open.store.generations();
                    fmt::print("generation  {}\n", open.generation.id());
                    for (const std::string& id : ids) {
                        if (id != open.generation.id()) fmt::print("also there  {}\n", id);
                    }
                    print_clips(open.generation.catalog());
                    print_stages(open.generation.ledger());
                    return ExitCode::success;
                };
            }};
}

Command verify_command() {
    return {"verify", "check every hash and law of a generation; print digests of its content",
            "kinetome verify motion.store --digest", [](CLI::App& app) -> Run {
                auto flags = std::make_shared<GenerationFlags>();
                auto digest = std::make_shared<bool>(false);
                flags->add_to(app);
                app.add_flag("--digest", *digest,
                             "print the digest of every dataset's logical rows");
                return [=](const Invocation& invocation) {
                    const StoreDirectory store = StoreDirectory::open(flags->store);
                    const std::string id = store.resolve_generation(flags->generation);
                    const auto findings = verify_generation(store, id);
                    for (const std::string& line : findings) invocation.log.error("{}", line);
                    if (!findings.empty()) return ExitCode::io;
                    if (*digest) {
                        const OpenStore open(flags->store, id);
                        for (const LogicalDigest& one : logical_digests(open.generation)) {
                            fmt::print("{}  {}:{}\n", one.digest.hex(), one.artifact, one.dataset);
                        }
                    } else {
                        fmt::print("generation {} is whole\n", id);
                    }
                    return ExitCode::success;
                };
            }};
}

Command gc_command() {
    return {"gc", "drop old generations", "kinetome gc motion.store --keep 3",
            [](CLI::App& app) -> Run {
                auto store = std::make_shared<fs::path>();
                auto keep = std::make_shared<int>(3);
                app.add_option("STORE", *store, "store to tidy")->required();
                app.add_option("--keep", *keep, "newest generations to keep")
                    ->check(above_zero())
                    ->capture_default_str();
                return [=](const Invocation& invocation) {
                    invocation.require_joined();
                    StoreDirectory directory = StoreDirectory::open(*store);
                    const StoreLock lock = directory.lock_writer();
                    const auto removed = directory.remove_old(*keep);
                    for (const std::string& id : removed) fmt::print("removed {}\n", id);
                    fmt::print("{} generations left\n", directory.generations().size());
                    return ExitCode::success;
                };
            }};
}

Command diff_command() {
    return {"diff", "tell what changed between two generations",
            "kinetome diff motion.store 20261121 current", [](CLI::App& app) -> Run {
                auto store = std::make_shared<fs::path>();
                auto first = std::make_shared<std::string>();
                auto second = std::make_shared<std::string>();
                app.add_option("STORE", *store, "store to read")->required();
                app.add_option("FIRST", *first, "id, the beginning of one, or current")->required();
                app.add_option("SECOND", *second, "the same")->required();
                return [=](const Invocation&) {
                    const OpenStore before(*store, *first), after(*store, *second);
                    const GenerationDifference difference =
                        compare_generations(before.generation, after.generation);
                    fmt::print("{} → {}\n", before.generation.id(), after.generation.id());
                    if (difference.empty()) fmt::print("no difference\n");
                    print_lines("clips added", difference.added);
                    print_lines("clips removed", difference.removed);
                    print_lines("clips changed", difference.changed);
                    print_lines("options", difference.options);
                    print_lines("files", difference.files);
                    print_lines("content", difference.datasets);
                    return ExitCode::success;
                };
            }};
}

}  // namespace kinetome::cli
