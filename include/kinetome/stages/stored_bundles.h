// The motion bundles of a store as walks and exports need them (S1 §4).
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "kinetome/models/bundle_graph.h"
#include "kinetome/models/bundle_score.h"
#include "kinetome/stages/export.h"
#include "kinetome/stages/primitive_walk.h"
#include "kinetome/stages/segment_table.h"
#include "kinetome/stages/stored_graph.h"

namespace kinetome {

/// Members of the bundles that are nodes of the bundle graph, by clip and frame, labelled
/// (label_from_table). Their cluster is the bundle's number. Throws UsageError when the generation
/// has no bundles.
std::vector<ClipPrimitive> stored_bundle_members(const OpenStore& open,
                                                 const std::filesystem::path& labels = {});

/// Bundles of different bodies that hold the same motion, by their numbers. Throws UsageError when
/// the generation has no bundles.
std::vector<ClusterLink> stored_bundle_links(const Generation& generation);

/// Bundles that are nodes, those of largest volume (S1 Eq. 3, the generation's ρ) first:
/// bundle,label,height,width,volume,takes; the label that most members have (label_from_table), the
/// width in frames at the rate of most members. Throws UsageError when the generation has none.
Table bundle_list(const OpenStore& open, const std::filesystem::path& labels = {});

/// Where the frames of the takes are, and how large bundles.h5 is.
struct BundleShares {
    BundleGraphFrames frames;  ///< at the pose rate
    uint64_t file_bytes = 0;
};
/// Throws UsageError when the generation has no bundles.
BundleShares bundle_shares(const Generation& generation);

/// Through bundles: going over lasts as long as both members do, and what lies between two members
/// of a clip is a transition however long it is (S1 §4).
WalkOptions options_of_bundle_walk(WalkOptions options);

/// Takes as bundles cut them, by name, at the sources' rates: an activity a member, whose cluster
/// is its bundle, and transitions between members and at the ends. Throws UsageError when the
/// generation has no bundles.
std::vector<SegmentedTake> stored_bundle_segments(const Generation& generation);

/// Motion bundles beside annotated activities (bundle_score.h), in takes that are annotated. Throws
/// UsageError when the generation has no bundles or none of those takes is in it.
BundleScore stored_bundle_score(const Generation& generation, std::span<const TruthRow> truth);
/// bundles,purity,shuffled,chance,coverage,mean_height,median_width
Table bundle_score_table(const BundleScore& score);

}  // namespace kinetome
