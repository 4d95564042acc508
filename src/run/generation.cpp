#include "kinetome/run/generation.h"

#include <fmt/format.h>

#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"

namespace kinetome {
namespace {

/// As shard_plan.h and stage tables name files: <stage>.h5 or <stage>-<shard>.h5.
std::string_view stage_of(std::string_view file_name) {
    return file_name.substr(0, file_name.find_first_of("-."));
}

}  // namespace

Generation::Generation(const StoreDirectory& store, const std::string& id, VerifiedFiles& verified)
    : store_(store.path()),
      id_(id),
      folder_(store.generation_folder(id)),
      verified_(&verified),
      lease_(store.lease(id)) {
    const auto ledger_path = folder_ / "ledger.json", catalog_path = folder_ / "catalog.json";
    ledger_ = parse_ledger(read_file(ledger_path), ledger_path);
    const std::string catalog = read_file(catalog_path);
    const auto written = ledger_.texts.find("catalog.json");
    if (written == ledger_.texts.end() || written->second != digest_of(catalog)) {
        throw DamagedError(catalog_path.string() + ": damaged: its bytes do not match the ledger");
    }
    catalog_ = parse_catalog(catalog, catalog_path);
}

ArtifactReader Generation::open(const std::string& file_name) const {
    const Receipt* receipt = ledger_.find(file_name);
    if (!receipt) throw left_out(stage_of(file_name));
    return ArtifactReader(folder_ / file_name, receipt->file.hash, *verified_);
}

std::vector<const Receipt*> Generation::made_by(std::string_view stage) const {
    std::vector<const Receipt*> receipts = ledger_.of_stage(stage);
    if (receipts.empty()) throw left_out(stage);
    return receipts;
}

UsageError Generation::left_out(std::string_view stage) const {
    const std::string store = path_for_message(store_.string());
    return UsageError(fmt::format(
        "{0}: generation {1} has no {2}, that stage was left out; `kinetome reindex {3} --store "
        "{0}` makes it",
        store, id_, stage, path_for_message(catalog_.corpus)));
}

}  // namespace kinetome
