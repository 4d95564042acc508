#include "kinetome/run/generation.h"

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"

namespace kinetome {

Generation::Generation(const StoreDirectory& store, const std::string& id, VerifiedFiles& verified)
    : id_(id), folder_(store.generation_folder(id)), verified_(&verified), lease_(store.lease(id)) {
    const auto ledger_path = folder_ / "ledger.json", catalog_path = folder_ / "catalog.json";
    ledger_ = parse_ledger(read_file(ledger_path), ledger_path);
    catalog_ = parse_catalog(read_file(catalog_path), catalog_path);
}

ArtifactReader Generation::open(const std::string& file_name) const {
    const Receipt* receipt = ledger_.find(file_name);
    if (!receipt) throw StoreError(folder_.string() + ": generation has no " + file_name);
    return ArtifactReader(folder_ / file_name, receipt->file.hash, *verified_);
}

}  // namespace kinetome
