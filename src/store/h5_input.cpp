#include <algorithm>
#include <array>
#include <map>

#include "h5_library.h"

namespace kinetome::h5 {
namespace {

namespace fs = std::filesystem;

/// Throws when a filter of the dataset is not to be had here.
void require_filters(hid_t dataset, const Context& context) {
    const Handle creation(check(H5Dget_create_plist(dataset), context), H5Pclose);
    const int filters = check(H5Pget_nfilters(creation.id()), context);
    for (int i = 0; i < filters; ++i) {
        unsigned flags = 0;
        size_t values = 0;
        std::array<char, 64> name{};
        const H5Z_filter_t filter =
            check(H5Pget_filter2(creation.id(), static_cast<unsigned>(i), &flags, &values, nullptr,
                                 name.size() - 1, name.data(), nullptr),
                  context);
        if (H5Zfilter_avail(filter) > 0) continue;
        throw StoreError(fmt::format(
            "{} in {} is compressed by HDF5 filter {} ({}), which is not installed: install that "
            "plugin (on Debian: apt-get install hdf5-filter-plugin-blosc-serial)",
            context.object, context.file.string(), filter, name.data()));
    }
}

ElementType element_type(hid_t type, const Context& context) {
    const H5T_class_t type_class = H5Tget_class(type);
    if (type_class == H5T_STRING && H5Tis_variable_str(type) == 0) return ElementType::text;
    for (const ElementType known : {ElementType::float32, ElementType::float64, ElementType::int32,
                                    ElementType::int64, ElementType::uint8, ElementType::uint64}) {
        if (H5Tequal(type, numeric_type(known)) > 0) return known;
    }
    throw StoreError(fmt::format("{} in {} is of a type that no artifact has", context.object,
                                 context.file.string()));
}

OpenDataset open_dataset(hid_t file, const Context& context) {
    OpenDataset open;
    open.dataset =
        Handle(check(H5Dopen2(file, context.object.c_str(), H5P_DEFAULT), context), H5Dclose);
    const hid_t id = open.dataset.id();
    require_filters(id, context);
    open.type = Handle(check(H5Dget_type(id), context), H5Tclose);
    open.layout.type = element_type(open.type.id(), context);
    if (open.layout.type == ElementType::text) {
        open.layout.text_width = static_cast<int64_t>(H5Tget_size(open.type.id()));
    }
    const Handle space(check(H5Dget_space(id), context), H5Sclose);
    const int rank = check(H5Sget_simple_extent_ndims(space.id()), context);
    const Handle creation(check(H5Dget_create_plist(id), context), H5Pclose);
    std::vector<hsize_t> dims(static_cast<size_t>(rank)), chunk(static_cast<size_t>(rank));
    if (rank == 0 || H5Pget_chunk(creation.id(), rank, chunk.data()) != rank) {
        throw StoreError(
            fmt::format("{} in {} is no table of rows", context.object, context.file.string()));
    }
    check(H5Sget_simple_extent_dims(space.id(), dims.data(), nullptr), context);
    open.layout.rows = static_cast<int64_t>(dims[0]);
    open.layout.row_shape.assign(dims.begin() + 1, dims.end());
    open.layout.chunk_rows = static_cast<int64_t>(chunk[0]);
    return open;
}

Handle open_attribute(hid_t file, const std::string& object, const std::string& name,
                      const Context& context) {
    const htri_t exists =
        check(H5Aexists_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT), context);
    if (exists == 0) return {};
    return {check(H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                  context),
            H5Aclose};
}

herr_t collect_link(hid_t, const char* name, const H5L_info_t*, void* data) {
    try {
        static_cast<std::vector<std::string>*>(data)->push_back(std::string("/") + name);
        return 0;
    } catch (...) {
        return -1;  // an exception must not pass through HDF5
    }
}

}  // namespace

struct InputFile::State {
    fs::path path;
    BackingFile backing;
    Handle file;
    std::map<std::string, OpenDataset> datasets;

    explicit State(fs::path file_path)
        : path(std::move(file_path)), backing(BackingFile::open_to_read(path)) {}

    /// Needs a session.
    const OpenDataset& open(const std::string& dataset) {
        const auto known = datasets.find(dataset);
        if (known != datasets.end()) return known->second;
        const Context context{"open", path, dataset};
        return datasets.emplace(dataset, open_dataset(file.id(), context)).first->second;
    }
};

InputFile::InputFile(const fs::path& path) : state_(std::make_unique<State>(path)) {
    const Session session;
    const Handle access = file_access(&state_->backing, path);
    state_->file = Handle(
        check(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()), {"open", path, whole_file}),
        H5Fclose);
}

InputFile::~InputFile() {
    const Session session;
    state_->datasets.clear();
    state_->file = Handle();
    H5Eclear2(H5E_DEFAULT);
}

std::optional<std::string> InputFile::text_attribute(const std::string& object,
                                                     const std::string& name) const {
    const Session session;
    const Context context{"read the attributes of", state_->path, object};
    const Handle attribute = open_attribute(state_->file.id(), object, name, context);
    if (attribute.id() < 0) return std::nullopt;
    const Handle type(check(H5Aget_type(attribute.id()), context), H5Tclose);
    if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0 ||
        H5Aget_storage_size(attribute.id()) != H5Tget_size(type.id())) {
        return std::nullopt;
    }
    std::string text(H5Tget_size(type.id()), '\0');
    check(H5Aread(attribute.id(), type.id(), text.data()), context);
    text.erase(text.find_last_not_of('\0') + 1);
    return text;
}

std::optional<int64_t> InputFile::number_attribute(const std::string& object,
                                                   const std::string& name) const {
    const Session session;
    const Context context{"read the attributes of", state_->path, object};
    const Handle attribute = open_attribute(state_->file.id(), object, name, context);
    if (attribute.id() < 0 || H5Aget_storage_size(attribute.id()) != sizeof(int64_t)) {
        return std::nullopt;
    }
    int64_t number = 0;
    check(H5Aread(attribute.id(), numeric_type(ElementType::int64), &number), context);
    return number;
}

std::vector<std::string> InputFile::datasets() const {
    const Session session;
    const Context context{"list", state_->path, whole_file};
    std::vector<std::string> links, found;
    check(H5Lvisit(state_->file.id(), H5_INDEX_NAME, H5_ITER_INC, collect_link, &links), context);
    for (const std::string& link : links) {
        const Handle object(check(H5Oopen(state_->file.id(), link.c_str(), H5P_DEFAULT),
                                  {"open", state_->path, link}),
                            H5Oclose);
        if (H5Iget_type(object.id()) == H5I_DATASET) found.push_back(link);
    }
    std::sort(found.begin(), found.end());
    return found;
}

const Layout& InputFile::layout(const std::string& dataset) const {
    const Session session;
    return state_->open(dataset).layout;
}

void InputFile::read_rows(const std::string& dataset, int64_t first, int64_t count,
                          void* values) const {
    if (count == 0) return;
    const Session session;
    const Context context{"read", state_->path, dataset};
    const OpenDataset& open = state_->open(dataset);
    const RowSelection rows =
        select_rows(open.dataset.id(), first, count, open.layout.row_shape, context);
    check(H5Dread(open.dataset.id(), open.type.id(), rows.memory.id(), rows.file.id(), H5P_DEFAULT,
                  values),
          context);
}

}  // namespace kinetome::h5
