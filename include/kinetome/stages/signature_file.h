// signatures.h5: the cluster transition signatures of takes, and the index they are searched by.
// Layout in docs/artifacts.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinetome/models/signature_index.h"
#include "kinetome/store/artifact.h"

namespace kinetome {

/// A clip whose signature is indexed; the signature's frames count at the pose rate.
struct SignatureClip {
    std::string name;
    int64_t frames = 0;  ///< at the pose rate
    int64_t source_frames = 0;
    double source_rate = 0;  ///< frames a second
};

/// Of one class of skeletons.
struct ClassSignatures {
    double pose_rate = 0;              ///< frames a second
    std::vector<SignatureClip> clips;  ///< in name order, as the index numbers them
    MatrixF axes;                      ///< of the positions in the index (signature_axes)
    SignatureIndex index;

    /// Where a boundary between frames lies in the source: at the first frame at it or after it.
    int64_t source_boundary(int32_t clip, int64_t frame) const;
};

/// `group`: "/<class>".
void write_signatures(ArtifactWriter& file, const std::string& group,
                      const ClassSignatures& signatures);
/// Throws StoreError when the file does not hold an index of that class.
ClassSignatures read_signatures(const ArtifactReader& file, const std::string& group);

/// Groups of the classes that a file holds, in name order.
std::vector<std::string> signature_classes(const ArtifactReader& file);

}  // namespace kinetome
