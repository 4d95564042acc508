#include "kinetome/store/feature_store.h"

#include "class_datasets.h"
#include "kinetome/store/catalog.h"
#include "kinetome/store/groups.h"

namespace kinetome {

FeatureShardWriter::FeatureShardWriter(const std::filesystem::path& path,
                                       const ArtifactHeader& header, const WriteOptions& options)
    : file_(path, header, options) {}

void FeatureShardWriter::begin_class(const std::string& name, const FeatureClass& shared) {
    const auto constant = [&](const char* what, ElementType type, const char* units,
                              const char* description) {
        return DatasetSpec{at(name, what), type, {}, units,
                           description,    "",   "", Sharding::constant};
    };
    file_.write_texts(constant("pose_vector_columns/name", ElementType::text, "1",
                               "what each column of pose_vectors is"),
                      shared.pose_vector_names);
    file_.write_texts(constant("pose_vector_columns/unit", ElementType::text, "1",
                               "unit of each column of pose_vectors"),
                      shared.pose_vector_units);
    file_.write<double>(constant("pose_vector_columns/floor", ElementType::float64, "column's unit",
                                 "least scale of each column when it is standardised"),
                        shared.pose_vector_floors);
    file_.write_texts(constant("marker_name", ElementType::text, "1", "name of each marker"),
                      shared.marker_names);
    file_.write<double>(
        constant("pose_rate", ElementType::float64, "frames/s", "rate of pose_vectors and markers"),
        one(shared.pose_rate));
    file_.write<double>(
        constant("effector_rate", ElementType::float64, "frames/s", "rate of effectors"),
        one(shared.effector_rate));

    const auto rows = [&](const char* what, ElementType type, std::vector<int64_t> shape,
                          const char* units, const char* description, const char* source = "",
                          const char* frame = "") {
        file_.create({at(name, what), type, std::move(shape), units, description, source, frame,
                      Sharding::rows});
    };
    rows("clips/id", ElementType::int64, {}, "1", "clip id");
    rows("clips/name", ElementType::text, {}, "1", "clip name");
    rows("clips/source_frames", ElementType::int64, {}, "frames", "frames of the source");
    rows("clips/source_rate", ElementType::float64, {}, "frames/s", "frame rate of the source");
    rows("clips/pose_rows", ElementType::int64, {}, "frames",
         "rows of the clip in pose_vectors and markers; they follow those of the clips before it");
    rows("clips/effector_rows", ElementType::int64, {}, "frames",
         "rows of the clip in effectors; they follow those of the clips before it");
    const auto columns = static_cast<int64_t>(shared.pose_vector_names.size());
    const auto markers = static_cast<int64_t>(shared.marker_names.size());
    rows("pose_vectors", ElementType::float32, {columns}, "see pose_vector_columns/unit",
         "frames without place and heading", "S1 §3.2", "facing frame");
    rows("markers", ElementType::float32, {markers, 3}, "cm", "joint positions as markers", "S2 §3",
         "root at the origin, hip axis along x, Y up");
    rows("effectors", ElementType::float32, {5, 3}, "cm",
         "head, left wrist, right wrist, left ankle, right ankle", "S3 §3", "root joint");
    classes_[name] = shared;
}

void FeatureShardWriter::add(const ClipFeatures& clip) {
    const auto path = [&](const char* what) { return at(clip.clip_class, what); };
    const int64_t id = clip_id(clip.name), pose_rows = clip.pose_vectors.rows(),
                  effector_rows = clip.effectors.rows();
    file_.append<int64_t>(path("clips/id"), one(id));
    file_.append_texts(path("clips/name"), one(clip.name));
    file_.append<int64_t>(path("clips/source_frames"), one(clip.source_frames));
    file_.append<double>(path("clips/source_rate"), one(clip.source_rate));
    file_.append<int64_t>(path("clips/pose_rows"), one(pose_rows));
    file_.append<int64_t>(path("clips/effector_rows"), one(effector_rows));
    file_.append(path("pose_vectors"), clip.pose_vectors);
    file_.append(path("markers"), clip.markers);
    if (effector_rows) file_.append(path("effectors"), clip.effectors);
}

ArtifactRecord FeatureShardWriter::close() {
    return file_.close();
}

FeatureShardReader::FeatureShardReader(ArtifactReader file) : file_(std::move(file)) {
    for (const std::string& group : groups_with(file_, "/clips/name")) {
        const std::string name = group.substr(1);
        const auto names = file_.read_texts(at(name, "clips/name"));
        const auto source_frames = file_.read<int64_t>(at(name, "clips/source_frames"));
        const auto source_rate = file_.read<double>(at(name, "clips/source_rate"));
        const auto pose_rows = file_.read<int64_t>(at(name, "clips/pose_rows"));
        const auto effector_rows = file_.read<int64_t>(at(name, "clips/effector_rows"));
        int64_t pose_row = 0, effector_row = 0;
        for (size_t i = 0; i < names.size(); ++i) {
            clips_.push_back({names[i], name, source_frames[i], source_rate[i], pose_row,
                              pose_rows[i], effector_row, effector_rows[i]});
            pose_row += pose_rows[i];
            effector_row += effector_rows[i];
        }
    }
}

FeatureClass FeatureShardReader::feature_class(const std::string& name) const {
    FeatureClass shared;
    shared.pose_vector_names = file_.read_texts(at(name, "pose_vector_columns/name"));
    shared.pose_vector_units = file_.read_texts(at(name, "pose_vector_columns/unit"));
    shared.pose_vector_floors = file_.read<double>(at(name, "pose_vector_columns/floor"));
    shared.marker_names = file_.read_texts(at(name, "marker_name"));
    shared.pose_rate = file_.read<double>(at(name, "pose_rate")).at(0);
    shared.effector_rate = file_.read<double>(at(name, "effector_rate")).at(0);
    return shared;
}

MatrixF FeatureShardReader::pose_vectors(const std::string& clip_class, int64_t first,
                                         int64_t count) const {
    return file_.read_matrix(at(clip_class, "pose_vectors"), first, count);
}

MatrixF FeatureShardReader::markers(const std::string& clip_class, int64_t first,
                                    int64_t count) const {
    return file_.read_matrix(at(clip_class, "markers"), first, count);
}

MatrixF FeatureShardReader::effectors(const std::string& clip_class, int64_t first,
                                      int64_t count) const {
    return file_.read_matrix(at(clip_class, "effectors"), first, count);
}

}  // namespace kinetome
