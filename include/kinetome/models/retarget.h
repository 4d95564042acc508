// A motion on another body of the same class.
#pragma once

#include <memory>

#include "kinetome/formats/clip.h"

namespace kinetome {

/// The clip on `skeleton`, of the same class: joints keep their angles, the root its rotation; its
/// position grows with the length of the legs (hip to ankle), so that the feet that stood on the
/// floor at height zero stand there still and go as far as the legs carry. Nothing is done about
/// hands or feet where proportions differ otherwise. The clip itself, when it has that skeleton.
/// Throws std::invalid_argument for skeletons of different classes, for one without hips and ankles
/// and for a root that is not free (RootChain::is_free).
Clip retarget(const Clip& clip, std::shared_ptr<const Skeleton> skeleton);

/// From hip to ankle, cm, the mean of both legs. Throws std::invalid_argument when hips or ankles
/// are not known.
double leg_length(const Skeleton& skeleton);

}  // namespace kinetome
