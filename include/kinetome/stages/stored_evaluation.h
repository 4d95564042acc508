// What `evaluate` asks a store for.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "kinetome/models/cluster_variance.h"
#include "kinetome/models/pose_recurrence.h"
#include "kinetome/run/generation.h"
#include "kinetome/stages/evaluation.h"
#include "kinetome/stages/segment_table.h"

namespace kinetome {

/// Takes by name, frames at the sources' rates: what segments.h5 and primitives.h5 hold, but for
/// what is shorter than a frame of its source.
std::vector<SegmentedTake> stored_segments(const Generation& generation);
std::vector<PrimitivesOfTake> stored_primitives(const Generation& generation);

/// Those of takes that are not segmented in the store, but are in it: rate and frames, to which the
/// rows of tables are held. Throws InputError naming `path` for a clip that the store does not
/// have, or whose segments end elsewhere.
void hold_to_store(std::vector<SegmentedTake>& takes, const Generation& generation,
                   const std::string& path);

/// What the peer method (ppca_segmentation.h) makes of takes of the store, by clip.
std::map<std::string, std::vector<Segment>> segments_by_ppca(std::span<const AnnotatedTake> takes,
                                                             const Generation& generation);

/// The paper's corpus statistic (S3 §1) of all takes that have effectors.
PoseRecurrence stored_recurrence(const Generation& generation);
Table recurrence_table(const PoseRecurrence& recurrence);

/// Intra-cluster variance (S3 §5.2) of the primitives of the clips, class of skeletons by class,
/// clusters as over the whole corpus. Of clusters with two primitives and more.
struct ClassVariances {
    std::string clip_class;
    std::vector<ClusterVariance> clusters;
};
std::vector<ClassVariances> stored_cluster_variances(const Generation& generation,
                                                     std::span<const std::string> clips);
Table variance_table(const std::vector<ClassVariances>& classes);

}  // namespace kinetome
