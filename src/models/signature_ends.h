// What the dynamic programmes that match signatures have in common: an end in the text, with the
// nearest alignment that leads there.
#pragma once

#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/signature_match.h"

namespace kinetome {

/// Every row of the distances is aligned, WarpWeight::first and slope_limited_steps (warp.h); a
/// column is `step` frames of the text.
std::vector<SignatureMatch> paced_ends(const MatrixFView& distances, int32_t step);

/// Run by run.
std::vector<SignatureMatch> run_ends(std::span<const SignatureRun> query,
                                     std::span<const SignatureRun> text,
                                     const MatrixFView& distances,
                                     const SignatureMatchOptions& options);

}  // namespace kinetome
