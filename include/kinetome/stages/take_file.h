// A take that is no part of a corpus, read from its file.
#pragma once

#include <filesystem>

#include "kinetome/formats/clip.h"

namespace kinetome {

struct TakeFileOptions {
    double rate = 120;                     ///< frames a second, where the format states none
    std::filesystem::path joint_map = {};  ///< TOML file for rigs with unknown joint names; "" none
};

/// The take with its skeleton, joints with their roles. An AMC file's skeleton is looked for beside
/// it as in a corpus: NN.asf (NN: the stem up to its first '_'), <stem>.asf, or the folder's only
/// ASF file. Throws UsageError for a name of no known format, InputError for what cannot be read or
/// parsed.
Clip read_take_file(const std::filesystem::path& path, const TakeFileOptions& options = {});

}  // namespace kinetome
