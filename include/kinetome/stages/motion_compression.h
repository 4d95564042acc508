// Clips of a store through the leaves of its pose hierarchy, and back to motion (S2 §5.1).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinetome/base/pieces.h"
#include "kinetome/formats/clip.h"
#include "kinetome/run/generation.h"
#include "kinetome/stages/compressed_file.h"

namespace kinetome {

struct CompressedMotion {
    CompressedHead head;
    CompressedSize size;
    double paper_ratio = 0;  ///< N f / (C f k + N k), S2 §5.1: without means, numbers of leaves,
                             ///< place and heading, all numbers being equally long
};

/// Writes clips of one class, at their sources' rates; of all leaves, those that they fall in.
/// Throws UsageError for a clip that is not indexed and for clips of several classes, StoreError,
/// CreateError.
CompressedMotion compress_clips(const Generation& generation, const std::vector<std::string>& clips,
                                const std::filesystem::path& output);

/// N f / (C f k + N k), as above.
double paper_ratio(const CompressedHead& head);

/// Frames of a clip of the file (nothing: all): poses (n × f, cm) as normalised_markers has them.
MatrixF decompressed_poses(const CompressedFile& file, const CompressedClip& clip,
                           const std::optional<RowRange>& frames);

/// The same as motion of the clip's skeleton, fitted to the poses where they stood. A frame is the
/// same whatever is decompressed with it, for any number of threads. Throws UsageError for frames
/// outside the clip, StoreError.
Clip decompressed_motion(const CompressedFile& file, const CompressedClip& clip,
                         const std::optional<RowRange>& frames, int threads);

}  // namespace kinetome
