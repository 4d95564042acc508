#include "kinetome/run/generation.h"

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"

namespace kinetome {

Generation::Generation(const StoreDirectory& store, const std::string& id, VerifiedFiles& verified)
    : id_(id), folder_(store.generation_folder(id)), verified_(&verified), lease_(store.lease(id)) {
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
    if (!receipt)
        throw StoreError(folder_.string() + ": generation has no " + file_name +
                         "; `kinetome reindex` without --only makes it");
    return ArtifactReader(folder_ / file_name, receipt->file.hash, *verified_);
}

}  // namespace kinetome
