// A published generation as a reader sees it, from beginning to end.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/base/error.h"
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

    /// Opens an artifact after its hash is checked. Throws StoreError, and UsageError when its
    /// stage was left out: it is not in the ledger.
    ArtifactReader open(const std::string& file_name) const;
    /// All that a stage made, in clip order. Throws UsageError when it was left out.
    std::vector<const Receipt*> made_by(std::string_view stage) const;

  private:
    UsageError left_out(std::string_view stage) const;

    std::filesystem::path store_;
    std::string id_;
    std::filesystem::path folder_;
    VerifiedFiles* verified_;
    StoreLock lease_;
    Ledger ledger_;
    Catalog catalog_;
};

}  // namespace kinetome
