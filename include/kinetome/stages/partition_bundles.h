// The motion bundles of one partition, from its string to frames.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "kinetome/base/packing.h"
#include "kinetome/math/mixture.h"
#include "kinetome/models/bundle_ends.h"
#include "kinetome/models/bundle_graph.h"
#include "kinetome/stages/motion_string_file.h"

namespace kinetome {

/// Members name clips of the partition. Bundles with several members come first.
struct PartitionBundles {
    std::vector<BundleMember> members;
    int32_t bundles = 0;     ///< degenerate ones among them
    double first_score = 0;  ///< of all ends, with mean frames (S1 Eq. 6)
    double end_score = 0;    ///< the same in the end
};

void pack(Packer& out, const PartitionBundles& bundles);
void unpack(Unpacker& in, PartitionBundles& bundles);

/// Projected poses of frames [first, end) of a clip of the partition.
using PoseReader = std::function<MatrixF(int32_t clip, int64_t first, int64_t end)>;

/// Where ranks share the partition (resources.ranks), the first alone looks for the frames at which
/// members begin and end, and has the result.
PartitionBundles find_partition_bundles(const StoredMotionString& spelled, const Mixture& mixture,
                                        const MotionBundleOptions& options,
                                        const BundleEndOptions& ends,
                                        const BundleResources& resources, const PoseReader& poses);

}  // namespace kinetome
