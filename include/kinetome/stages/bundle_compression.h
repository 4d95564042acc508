// What a store's motion bundles would save, and at what error (S1 §6).
#pragma once

#include <cstdint>

#include "kinetome/run/generation.h"
#include "kinetome/stages/export.h"

namespace kinetome {

/// Of each bundle that is a node one member is kept (representative_of), which is shown in the
/// place of the others, warped in time; frames outside bundles stay.
struct StoredBundleCompression {
    int64_t frames = 0;         ///< of all clips with bundles, at the pose rate
    int64_t kept_frames = 0;    ///< of those
    double rms_mm = 0;          ///< per marker, without place and heading: of the frames not kept
    double control_rms_mm = 0;  ///< the same, each bundle shown by what stands for the next one
    uint64_t file_bytes = 0;    ///< of bundles.h5
    uint64_t text_bytes = 0;  ///< of the table that `export bundles` writes: S1 §5.1 tells of text
};

/// Throws UsageError when the generation has no bundles.
StoredBundleCompression stored_bundle_compression(const Generation& generation);

/// frames,kept_frames,ratio,rms_mm,control_rms_mm,file_bytes,text_bytes as further columns of a
/// table of one row.
void append_compression(const StoredBundleCompression& compression, Table& table);

}  // namespace kinetome
