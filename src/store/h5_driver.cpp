#include "h5_driver.h"

#include <algorithm>
#include <array>
#include <memory>

#include "backing_file.h"

namespace kinetome::h5 {
namespace {

/// What HDF5 holds of an open file; it looks at the first member only.
struct DriverFile {
    H5FD_t hdf5{};
    BackingFile* backing = nullptr;
    haddr_t end_of_allocation = 0;
};

DriverFile* driver_file(H5FD_t* file) {
    return reinterpret_cast<DriverFile*>(file);
}
const DriverFile* driver_file(const H5FD_t* file) {
    return reinterpret_cast<const DriverFile*>(file);
}

H5FD_t* driver_open(const char*, unsigned, hid_t access, haddr_t) {
    const auto* info = static_cast<BackingFile* const*>(H5Pget_driver_info(access));
    if (!info) return nullptr;
    auto file = std::make_unique<DriverFile>();
    file->backing = *info;
    return &file.release()->hdf5;
}

herr_t driver_close(H5FD_t* file) {
    const std::unique_ptr<DriverFile> owned(driver_file(file));
    return 0;
}

herr_t driver_query(const H5FD_t*, unsigned long* flags) {
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
}

haddr_t driver_end_of_allocation(const H5FD_t* file, H5FD_mem_t) {
    return driver_file(file)->end_of_allocation;
}

herr_t driver_set_end_of_allocation(H5FD_t* file, H5FD_mem_t, haddr_t end) {
    driver_file(file)->end_of_allocation = end;
    return 0;
}

haddr_t driver_end_of_file(const H5FD_t* file, H5FD_mem_t) {
    return driver_file(file)->backing->size();
}

herr_t driver_read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, size_t bytes, void* data) {
    return driver_file(file)->backing->read(offset, data, bytes) ? 0 : -1;
}

herr_t driver_write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, size_t bytes,
                    const void* data) {
    driver_file(file)->backing->write(offset, data, bytes);
    return 0;
}

herr_t driver_truncate(H5FD_t* file, hid_t, hbool_t) {
    BackingFile& backing = *driver_file(file)->backing;
    const haddr_t end = driver_file(file)->end_of_allocation;
    if (backing.size() != end) backing.resize(end);
    return 0;
}

H5FD_class_t driver_class() {
    H5FD_class_t driver{};
    driver.name = "kinetome";
    driver.maxaddr = (haddr_t{1} << 63) - 1;
    driver.fc_degree = H5F_CLOSE_STRONG;
    driver.fapl_size = sizeof(BackingFile*);
    driver.open = driver_open;
    driver.close = driver_close;
    driver.query = driver_query;
    driver.get_eoa = driver_end_of_allocation;
    driver.set_eoa = driver_set_end_of_allocation;
    driver.get_eof = driver_end_of_file;
    driver.read = driver_read;
    driver.write = driver_write;
    driver.truncate = driver_truncate;
    const std::array<H5FD_mem_t, H5FD_MEM_NTYPES> memory_types = H5FD_FLMAP_DICHOTOMY;
    std::copy(memory_types.begin(), memory_types.end(), driver.fl_map);
    return driver;
}

}  // namespace

hid_t registered_driver() {
    static const H5FD_class_t driver = driver_class();
    static const hid_t id = H5FDregister(&driver);
    return id;
}

}  // namespace kinetome::h5
