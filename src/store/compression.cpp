#include "kinetome/store/compression.h"

#include "h5.h"
#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"

namespace kinetome {

Compression parse_compression(std::string_view name) {
    if (name == "none") return Compression::none;
    if (name == "gzip") return Compression::gzip;
    if (name != "blosc") {
        throw UsageError("compression " + quote_for_message(name) +
                         " is not known; use none, gzip or blosc");
    }
    if (!h5::has_blosc()) {
        throw UsageError(
            "compression blosc needs HDF5's blosc plugin, which was not found: install it (on "
            "Debian: apt-get install hdf5-filter-plugin-blosc-serial) or use gzip");
    }
    return Compression::blosc;
}

}  // namespace kinetome
