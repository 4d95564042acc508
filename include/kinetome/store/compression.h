// How the values of an artifact are stored; no option changes what is read back.
#pragma once

#include <string_view>

namespace kinetome {

enum class Compression {
    none,
    gzip,   ///< level 1 after shuffling the bytes of the values: every HDF5 reads it
    blosc,  ///< LZ4, shuffled: fast, but every reader needs the plugin (HDF5 filter 32001)
};

/// Throws UsageError for another name, or for blosc when its plugin is not installed.
Compression parse_compression(std::string_view name);

}  // namespace kinetome
