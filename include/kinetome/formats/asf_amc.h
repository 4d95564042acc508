// ASF skeletons and AMC takes (Acclaim; the formats of CMU and HDM05).
//
// Lengths: an ASF number is inches divided by the `length` of its :units section, so a number is
// 2.54 / length centimetres. Rotations of a joint act in the order of its `dof` line, the first one
// first, about the axes its `axis` line states; `orientation` is the root's axis.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "kinetome/formats/clip.h"
#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// Parses an ASF file: joint 0 is `root`, then the bones depth first as :hierarchy lists them; a
/// bone's position is its far end. Bones and sections may come in any order; comments (#), CRLF,
/// tabs, missing ids and missing limits are read. `path` is for messages only. Throws InputError
/// ("path:line: expected …, found …").
Skeleton parse_asf(std::string_view text, const std::string& path);

struct AmcOptions {
    double rate = 120.0;  ///< frames a second of takes that do not state it; few AMC files do
};

/// Parses an AMC file: joints of a frame in any order, but each once in each frame; frame numbers
/// consecutive from any start; degrees unless the take or its ASF says radians. `path` is for
/// messages only. Memory stays proportional to the size of the text, whatever it claims. Throws
/// InputError ("path:line: expected …, found …").
Clip parse_amc(std::string_view text, const std::string& path,
               std::shared_ptr<const Skeleton> skeleton, const AmcOptions& options = {});

/// Frames an AMC file claims: its lines that begin with a digit. Reads nothing else, so it is quick
/// enough to plan with; for a file that parse_amc accepts it is the number of frames.
int64_t count_amc_frames(std::string_view text);

}  // namespace kinetome
