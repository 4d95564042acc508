// Whether a generation is what its ledger says: hashes, laws, digests (design §4, §5).
#pragma once

#include <string>
#include <vector>

#include "kinetome/base/digest.h"
#include "kinetome/stages/open_store.h"

namespace kinetome {

/// Everything found wrong, one line each, naming file and, where the damage is in chunk data, the
/// dataset. Empty: the generation is whole.
std::vector<std::string> verify_generation(const StoreDirectory& store, const std::string& id);

struct LogicalDigest {
    std::string artifact;  ///< stage name: all its shards are one artifact
    std::string dataset;   ///< path inside
    Digest digest;
};

/// Digest of every dataset over its logical rows, read from the files, in table and path order.
std::vector<LogicalDigest> logical_digests(const Generation& generation);

}  // namespace kinetome
