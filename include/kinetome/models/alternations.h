// Primitives that were cut too short, put together again (S3 §7).
#pragma once

#include <cstdint>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/primitive_clusters.h"
#include "kinetome/models/segment.h"

namespace kinetome {

/// The primitives of a take, in order.
struct TakePrimitives {
    std::vector<Primitive> primitives;
    std::vector<int32_t> clusters;  ///< of each, numbered as they appear (cluster_take)
};

struct AlternationOptions {
    bool joined = false;        ///< whether reindex joins them
    double share = 0.9;         ///< of the primitives of both clusters that must be side by side
    int64_t least_repeats = 2;  ///< of the pair, one after another without a gap
};

/// Primitives of an activity joined and clustered again: where those of one cluster are always
/// followed by those of another, as one half of a double step by the other, the two are one
/// movement. Primitives that adjoin no other of their activity do not count. Of the ways to pair
/// clusters those that join more primitives are taken, then those whose first cluster is the lower;
/// what is left over at the ends of an alternation stays as it is. Repeated until nothing is
/// joined. `features` are those of the take. Throws std::invalid_argument unless each primitive has
/// one cluster, and what cluster_primitives throws.
TakePrimitives join_alternations(const MatrixFView& features, TakePrimitives take,
                                 const AlternationOptions& alternation,
                                 const PrimitiveClusterOptions& options);

}  // namespace kinetome
