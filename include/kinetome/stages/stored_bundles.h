// The motion bundles of a store as walks and exports need them (S1 §4).
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "kinetome/models/bundle_score.h"
#include "kinetome/stages/export.h"
#include "kinetome/stages/primitive_walk.h"
#include "kinetome/stages/stored_graph.h"

namespace kinetome {

/// Members of the bundles that are nodes of the bundle graph, by clip and frame, labelled
/// (label_from_table). Their cluster is the node's number. Throws UsageError when the generation
/// has no bundles.
std::vector<ClipPrimitive> stored_bundle_members(const OpenStore& open,
                                                 const std::filesystem::path& labels = {});

/// Through bundles: going over lasts as long as both members do, and what lies between two members
/// of a clip is a transition however long it is (S1 §4).
WalkOptions options_of_bundle_walk(WalkOptions options);

/// Motion bundles beside annotated activities (bundle_score.h), in takes that are annotated. Throws
/// UsageError when the generation has no bundles or none of those takes is in it.
BundleScore stored_bundle_score(const Generation& generation, std::span<const TruthRow> truth);
/// bundles,purity,shuffled,chance,coverage,mean_height,median_width
Table bundle_score_table(const BundleScore& score);

}  // namespace kinetome
