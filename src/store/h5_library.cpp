#include "h5_library.h"

#include "h5_driver.h"

namespace kinetome::h5 {

std::mutex& library_mutex() {
    static std::mutex mutex;
    return mutex;
}

bool has_blosc() {
    const Session session;
    return H5Zfilter_avail(blosc_filter) > 0;
}

std::string explanation() {
    std::string text;
    const auto take_first = [](unsigned, const H5E_error2_t* entry, void* data) -> herr_t {
        auto& found = *static_cast<std::string*>(data);
        if (found.empty() && entry->desc) found = entry->desc;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &text);
    H5Eclear2(H5E_DEFAULT);
    return text.empty() ? "HDF5 does not say why" : text;
}

Handle file_access(BackingFile* backing, const std::filesystem::path& file) {
    const Context context{"set up", file, whole_file};
    Handle access(check(H5Pcreate(H5P_FILE_ACCESS), context), H5Pclose);
    check(H5Pset_driver(access.id(), registered_driver(), &backing), context);
    check(H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110), context);
    check(H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG), context);
    return access;
}

hid_t numeric_type(ElementType type) {
    switch (type) {
        case ElementType::float32:
            return H5T_IEEE_F32LE;
        case ElementType::float64:
            return H5T_IEEE_F64LE;
        case ElementType::int32:
            return H5T_STD_I32LE;
        case ElementType::int64:
            return H5T_STD_I64LE;
        case ElementType::uint8:
            return H5T_STD_U8LE;
        case ElementType::uint64:
            return H5T_STD_U64LE;
        case ElementType::text:
            break;
    }
    throw std::logic_error("texts have no numeric type");
}

Handle text_type(int64_t width, const Context& context) {
    Handle type(check(H5Tcopy(H5T_C_S1), context), H5Tclose);
    check(H5Tset_size(type.id(), static_cast<size_t>(width)), context);
    check(H5Tset_strpad(type.id(), H5T_STR_NULLPAD), context);
    check(H5Tset_cset(type.id(), H5T_CSET_UTF8), context);
    return type;
}

Handle value_type(ElementType type, int64_t text_width, const Context& context) {
    if (type == ElementType::text) return text_type(text_width, context);
    return {check(H5Tcopy(numeric_type(type)), context), H5Tclose};
}

std::vector<hsize_t> extent(int64_t rows, const std::vector<int64_t>& row_shape) {
    std::vector<hsize_t> dims{static_cast<hsize_t>(rows)};
    for (const int64_t size : row_shape) dims.push_back(static_cast<hsize_t>(size));
    return dims;
}

RowSelection select_rows(hid_t dataset, int64_t first, int64_t count,
                         const std::vector<int64_t>& row_shape, const Context& context) {
    RowSelection selection;
    std::vector<hsize_t> start(row_shape.size() + 1, 0);
    start[0] = static_cast<hsize_t>(first);
    const std::vector<hsize_t> size = extent(count, row_shape);
    selection.file = Handle(check(H5Dget_space(dataset), context), H5Sclose);
    check(H5Sselect_hyperslab(selection.file.id(), H5S_SELECT_SET, start.data(), nullptr,
                              size.data(), nullptr),
          context);
    selection.memory = Handle(
        check(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), context),
        H5Sclose);
    return selection;
}

}  // namespace kinetome::h5
