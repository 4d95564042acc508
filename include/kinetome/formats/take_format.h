// The formats of takes as a table: a new format is a row.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "kinetome/formats/clip.h"

namespace kinetome {

/// The content of a take's file and what else its format needs.
struct TakeSource {
    std::string_view bytes;
    std::string path;                          ///< for messages only
    std::shared_ptr<const Skeleton> skeleton;  ///< for formats that keep it in a file of its own
    double default_rate = 120.0;               ///< frames a second, where the file states none
};

struct TakeFormat {
    std::string_view extension;           ///< lower case, with its dot
    std::string_view skeleton_extension;  ///< of the file that holds the skeleton; empty: the take
    int64_t (*count_frames)(std::string_view bytes);  ///< what the file claims; reads no motion
    Clip (*parse)(const TakeSource& source);          ///< throws InputError
};

std::span<const TakeFormat> take_formats();

/// The format of files with this extension (any case, with its dot), or nullptr.
const TakeFormat* find_take_format(std::string_view extension);

}  // namespace kinetome
