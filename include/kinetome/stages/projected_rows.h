// A partition's pose vectors in the space of its principal components, read and projected when they
// are asked for; pieces stay in memory as far as the budget allows.
#pragma once

#include <cstdint>

#include "kinetome/base/communicator.h"
#include "kinetome/base/stop.h"
#include "kinetome/math/kept_rows.h"
#include "kinetome/math/pca.h"
#include "kinetome/stages/pose_rows.h"

namespace kinetome {

/// n × D. Reading throws Interrupted when a stop was asked for. Keeps pieces of this rank's share,
/// `kept_bytes` at most. Refers to partition and components.
KeptRows projected_rows(const PosePartition& partition, const Pca& pca, const Workers& workers,
                        uint64_t kept_bytes, StopToken stop);

}  // namespace kinetome
