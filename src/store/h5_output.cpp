#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "h5_library.h"
#include "kinetome/base/file.h"

namespace kinetome::h5 {
namespace {

namespace fs = std::filesystem;

void add_filters(hid_t creation, const Layout& layout, const Context& context) {
    if (layout.compression == Compression::gzip) {
        check(H5Pset_shuffle(creation), context);
        check(H5Pset_deflate(creation, 1), context);
    } else if (layout.compression == Compression::blosc) {
        // Reserved ×4, level, byte shuffle, codec LZ4 (hdf5-blosc's README). Optional: what does
        // not shrink is stored as it is.
        constexpr std::array<unsigned, 7> options{0, 0, 0, 0, 1, 1, 1};
        check(H5Pset_filter(creation, blosc_filter, H5Z_FLAG_OPTIONAL, options.size(),
                            options.data()),
              context);
    }
    check(H5Pset_fletcher32(creation), context);
}

Handle without_times(hid_t property_class, const Context& context) {
    Handle properties(check(H5Pcreate(property_class), context), H5Pclose);
    check(H5Pset_obj_track_times(properties.id(), false), context);
    return properties;
}

Handle dataset_creation(const Layout& layout, const Context& context) {
    Handle creation = without_times(H5P_DATASET_CREATE, context);
    const std::vector<hsize_t> chunk = extent(layout.chunk_rows, layout.row_shape);
    check(H5Pset_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data()), context);
    check(H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER), context);
    add_filters(creation.id(), layout, context);
    return creation;
}

void write_attribute(hid_t object, const Attribute& attribute, const Context& context) {
    const auto* text = std::get_if<std::string>(&attribute.value);
    // HDF5 has no text of no bytes: an empty one is one byte of padding.
    const int64_t width = text ? std::max<int64_t>(1, static_cast<int64_t>(text->size())) : 0;
    const Handle type =
        text ? text_type(width, context) : value_type(ElementType::int64, 0, context);
    const Handle space(check(H5Screate(H5S_SCALAR), context), H5Sclose);
    const Handle written(check(H5Acreate2(object, attribute.name.c_str(), type.id(), space.id(),
                                          H5P_DEFAULT, H5P_DEFAULT),
                               context),
                         H5Aclose);
    const void* value =
        text ? static_cast<const void*>(text->c_str()) : &std::get<int64_t>(attribute.value);
    check(H5Awrite(written.id(), type.id(), value), context);
}

}  // namespace

struct OutputFile::State {
    fs::path shown;
    BackingFile backing;
    Handle file;
    std::map<std::string, OpenDataset> datasets;
    std::set<std::string> groups;

    State(const fs::path& path, fs::path shown_as)
        : shown(std::move(shown_as)), backing(BackingFile::create_new(path, shown)) {}

    void require_written() const {
        if (backing.error() != 0) throw create_error("write", shown, backing.error());
    }

    void create_parents(const std::string& path) {
        for (size_t slash = path.find('/', 1); slash != std::string::npos;
             slash = path.find('/', slash + 1)) {
            const std::string group = path.substr(0, slash);
            if (!groups.insert(group).second) continue;
            const Context context{"make", shown, group};
            const Handle creation = without_times(H5P_GROUP_CREATE, context);
            const Handle made(
                check(H5Gcreate2(file.id(), group.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
                      context),
                H5Gclose);
        }
    }
};

OutputFile::OutputFile(const fs::path& path, const fs::path& shown)
    : state_(std::make_unique<State>(path, shown)) {
    const Session session;
    const Context context{"create", shown, whole_file};
    const Handle creation = without_times(H5P_FILE_CREATE, context);
    const Handle access = file_access(&state_->backing, shown);
    state_->file =
        Handle(check(H5Fcreate(path.c_str(), H5F_ACC_EXCL, creation.id(), access.id()), context),
               H5Fclose);
}

OutputFile::~OutputFile() {
    const Session session;
    state_->backing.discard();
    state_->datasets.clear();
    state_->file = Handle();
    H5Eclear2(H5E_DEFAULT);
}

void OutputFile::set_attributes(const std::string& object, std::span<const Attribute> attributes) {
    const Session session;
    const Context context{"describe", state_->shown, object};
    const Handle opened(check(H5Oopen(state_->file.id(), object.c_str(), H5P_DEFAULT), context),
                        H5Oclose);
    for (const Attribute& attribute : attributes) {
        write_attribute(opened.id(), attribute, context);
    }
    state_->require_written();
}

void OutputFile::create_dataset(const std::string& path, const Layout& layout) {
    const Session session;
    const Context context{"make", state_->shown, path};
    state_->create_parents(path);
    const std::vector<hsize_t> dims = extent(layout.rows.value_or(0), layout.row_shape);
    std::vector<hsize_t> most = dims;
    if (!layout.rows) most[0] = H5S_UNLIMITED;
    const Handle space(
        check(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), most.data()), context),
        H5Sclose);
    const Handle creation = dataset_creation(layout, context);
    // Rows come in whole chunks, which need no cache; without one, chunks reach the file in the
    // order they are written.
    const Handle access(check(H5Pcreate(H5P_DATASET_ACCESS), context), H5Pclose);
    check(H5Pset_chunk_cache(access.id(), 0, 0, H5D_CHUNK_CACHE_W0_DEFAULT), context);
    OpenDataset opened;
    opened.layout = layout;
    opened.type = value_type(layout.type, layout.text_width, context);
    opened.dataset = Handle(check(H5Dcreate2(state_->file.id(), path.c_str(), opened.type.id(),
                                             space.id(), H5P_DEFAULT, creation.id(), access.id()),
                                  context),
                            H5Dclose);
    state_->datasets.emplace(path, std::move(opened));
    state_->require_written();
}

void OutputFile::write_rows(const std::string& dataset, int64_t first, int64_t count,
                            const void* values) {
    const Session session;
    const Context context{"write", state_->shown, dataset};
    const OpenDataset& open = state_->datasets.at(dataset);
    if (!open.layout.rows) {
        const std::vector<hsize_t> dims = extent(first + count, open.layout.row_shape);
        check(H5Dset_extent(open.dataset.id(), dims.data()), context);
    }
    const RowSelection rows =
        select_rows(open.dataset.id(), first, count, open.layout.row_shape, context);
    check(H5Dwrite(open.dataset.id(), open.type.id(), rows.memory.id(), rows.file.id(), H5P_DEFAULT,
                   values),
          context);
    state_->require_written();
}

void OutputFile::close() {
    const Session session;
    const Context context{"close", state_->shown, whole_file};
    for (auto& [path, open] : state_->datasets) check(open.dataset.close(), context);
    check(state_->file.close(), context);
    state_->backing.close();
    state_->require_written();
}

}  // namespace kinetome::h5
