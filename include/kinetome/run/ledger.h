// The ledger: what a run made or reused, under which key, with what hash, at what cost. It is the
// truth about a store, not the scheduler's state (design §4).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/run/key.h"
#include "kinetome/store/artifact.h"

namespace kinetome {

/// What became of one clip in the work a receipt is for.
struct ClipOutcome {
    std::string clip{};
    std::string quarantined{};  ///< reason; "" when it went through
    std::string skipped{};      ///< reason this stage left it out; "" when it did not
    int64_t frames = 0;         ///< at the source's rate
    double rate = 0;            ///< frames a second
    std::string clip_class{};
    std::vector<std::string> capabilities{};
    std::vector<std::string> warnings{};
};

/// Seconds and bytes that a piece of work took.
struct Cost {
    double seconds = 0;
    double cpu_seconds = 0;
    uint64_t peak_bytes = 0;  ///< highest resident size meanwhile
};

/// One finished artifact.
struct Receipt {
    std::string stage;
    std::string shard;  ///< cut name; "" for stages that make one file
    StageKey key;
    ArtifactRecord file;
    std::vector<ClipOutcome> clips;  ///< in name order; only those with something to say
    Cost cost;                       ///< of making it, whenever that was
};

std::string write_receipt(const Receipt& receipt);
/// Throws StoreError naming `path` for anything that is not a receipt.
Receipt parse_receipt(std::string_view json, const std::filesystem::path& path);

struct Ledger {
    std::string version;                    ///< of the program
    std::vector<Receipt> receipts;          ///< stages in table order, shards in clip order
    std::map<std::string, Digest> texts{};  ///< hash of each further file of the generation

    /// Nothing when the stage did not make that file.
    const Receipt* find(std::string_view file_name) const;
    std::vector<const Receipt*> of_stage(std::string_view stage) const;
};

/// JSON that carries its own hash.
std::string write_ledger(const Ledger& ledger);
/// Throws StoreError naming `path` unless every byte is as written.
Ledger parse_ledger(std::string_view json, const std::filesystem::path& path);

}  // namespace kinetome
