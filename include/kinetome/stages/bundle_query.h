// A motion bundle as a query: where else in the store motion like its own is (S1 §6).
#pragma once

#include <filesystem>
#include <string>

#include "kinetome/stages/open_store.h"
#include "kinetome/stages/signature_query.h"

namespace kinetome {

/// query_table for the member that stands for the bundle (representative_of), without the answers
/// that share more of the shorter of both with a member than two answers may. `bundle`: its number,
/// or a label (stored_bundle_members) that only one bundle has; clip, file and frames of `query`
/// are of no matter. Throws what query_table and stored_bundle_members throw, and UsageError when
/// no bundle, or more than one, is called that.
Table bundle_query_table(const OpenStore& open, const std::string& bundle,
                         const std::filesystem::path& labels, SignatureQuery query, int threads);

}  // namespace kinetome
