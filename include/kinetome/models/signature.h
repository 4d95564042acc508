// Cluster transition signatures (S2 §5.3): a motion as the leaves of the pose hierarchy that it
// passes through.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/pieces.h"

namespace kinetome {

/// Consecutive frames of one leaf.
struct SignatureRun {
    int32_t leaf = 0;
    int32_t first_frame = 0;
    int32_t frames = 0;

    int32_t end_frame() const { return first_frame + frames; }
    bool operator==(const SignatureRun&) const = default;
};

/// The runs of a motion, from its frame 0 to its last, without gaps; neighbours differ in leaf.
using Signature = std::vector<SignatureRun>;

/// Of a motion with a leaf a frame.
Signature make_signature(std::span<const int32_t> frame_leaves);

int32_t frame_count(std::span<const SignatureRun> signature);

/// The run that holds a frame of the signature.
int64_t run_at(std::span<const SignatureRun> signature, int64_t frame);

/// Of the frames of a part alone, which then count from 0. Throws std::out_of_range unless the part
/// lies inside.
Signature part_of(std::span<const SignatureRun> signature, const RowRange& frames);

}  // namespace kinetome
