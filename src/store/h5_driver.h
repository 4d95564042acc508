// The driver through which HDF5 reads and writes a BackingFile.
#pragma once

#include <hdf5.h>

namespace kinetome::h5 {

/// Its property is a BackingFile*. Needs the library's lock.
hid_t registered_driver();

}  // namespace kinetome::h5
