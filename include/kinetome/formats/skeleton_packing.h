// A skeleton as bytes: for files that carry their own.
#pragma once

#include "kinetome/base/packing.h"
#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// All but limits and source units.
void pack(Packer& out, const Skeleton& skeleton);
/// Throws std::out_of_range for bytes that are no skeleton.
void unpack(Unpacker& in, Skeleton& skeleton);

}  // namespace kinetome
