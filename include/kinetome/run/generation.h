// A published generation as a reader sees it, from beginning to end.
#pragma once

#include <filesystem>
#include <string>

#include "kinetome/run/ledger.h"
#include "kinetome/store/artifact.h"
#include "kinetome/store/catalog.h"
#include "kinetome/store/store_directory.h"
#include "kinetome/store/verified_files.h"

namespace kinetome {

/// Holds a lease, so that gc leaves it alone. Throws StoreError when ledger or catalog is damaged.
class Generation {
  public:
    /// `id` is a full generation id (StoreDirectory::resolve_generation). `verified` outlives it.
    Generation(const StoreDirectory& store, const std::string& id, VerifiedFiles& verified);

    const std::string& id() const { return id_; }
    const std::filesystem::path& folder() const { return folder_; }
    const Ledger& ledger() const { return ledger_; }
    const Catalog& catalog() const { return catalog_; }

    /// Opens an artifact after its hash is checked. Throws StoreError when it is not in the ledger.
    ArtifactReader open(const std::string& file_name) const;

  private:
    std::string id_;
    std::filesystem::path folder_;
    VerifiedFiles* verified_;
    StoreLock lease_;
    Ledger ledger_;
    Catalog catalog_;
};

}  // namespace kinetome
