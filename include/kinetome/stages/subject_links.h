// Bundles of subjects that were partitioned, linked across them.
#pragma once

#include <cstdint>
#include <vector>

#include "kinetome/stages/bundle_file.h"
#include "kinetome/stages/stage.h"

namespace kinetome {

/// Links between bundles with several members, by their numbers: inside each class of skeletons
/// that has several partitions. Only its takes are read again from `frames`, the finished shards;
/// those whose skeleton lacks a joint (bundle_link_rows.h) have no links. Every rank calls, reads a
/// part and gets the same.
std::vector<BundleLink> link_subjects(const StageContext& context,
                                      const std::vector<const FinishedWork*>& frames,
                                      const StoredBundles& bundles);

}  // namespace kinetome
