#include "kinetome/store/frame_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "kinetome/base/error.h"
#include "kinetome/store/catalog.h"
#include "kinetome/store/groups.h"

namespace kinetome {
namespace {

std::string channels_text(const Joint& joint) {
    std::vector<std::string_view> names;
    for (const Channel channel : joint.channels) names.push_back(channel_name(channel));
    return fmt::format("{}", fmt::join(names, " "));
}

std::vector<Channel> parse_channels(const std::string& text) {
    std::vector<Channel> channels;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        const auto channel = find_channel(word);
        if (!channel) throw StoreError("unknown channel " + word);
        channels.push_back(*channel);
    }
    return channels;
}

/// Roles of each joint, separated by spaces.
std::vector<std::string> role_texts(const Skeleton& skeleton) {
    std::vector<std::string> texts(static_cast<size_t>(skeleton.joint_count()));
    for (int r = 0; r < joint_role_count; ++r) {
        const auto role = static_cast<JointRole>(r);
        const int joint = skeleton.role(role);
        if (joint < 0) continue;
        std::string& text = texts[static_cast<size_t>(joint)];
        text += (text.empty() ? "" : " ") + std::string(joint_role_name(role));
    }
    return texts;
}

void set_roles(Skeleton& skeleton, const std::vector<std::string>& texts) {
    for (int r = 0; r < joint_role_count; ++r) {
        const auto role = static_cast<JointRole>(r);
        for (size_t j = 0; j < texts.size(); ++j) {
            std::istringstream words(texts[j]);
            for (std::string word; words >> word;) {
                if (word == joint_role_name(role)) skeleton.set_role(role, static_cast<int>(j));
            }
        }
    }
}

DatasetSpec constant(const std::string& path, ElementType type, const std::string& units,
                     const std::string& description) {
    return {path, type, {}, units, description, "", "", Sharding::constant};
}

/// Where each thing is inside a class's group.
struct Paths {
    explicit Paths(const std::string& clip_class) : base("/" + clip_class) {}
    std::string base;
    std::string joint(const char* what) const { return base + "/joints/" + what; }
    std::string clip(const char* what) const { return base + "/clips/" + what; }
    std::string motion() const { return base + "/motion"; }
    std::string positions() const { return base + "/positions"; }
};

std::vector<double> flatten(const std::vector<Eigen::Vector3d>& vectors) {
    std::vector<double> flat;
    for (const auto& vector : vectors) flat.insert(flat.end(), vector.data(), vector.data() + 3);
    return flat;
}

Eigen::Vector3d vector_at(const std::vector<double>& flat, size_t joint) {
    return {flat[3 * joint], flat[3 * joint + 1], flat[3 * joint + 2]};
}

}  // namespace

FrameShardWriter::FrameShardWriter(const std::filesystem::path& path, const ArtifactHeader& header,
                                   const WriteOptions& options)
    : file_(path, header, options) {}

void FrameShardWriter::begin_class(const std::string& name, const Skeleton& skeleton) {
    const Paths at(name);
    const int64_t joints = skeleton.joint_count();

    std::vector<std::string> names, channels;
    std::vector<int32_t> parents;
    std::vector<uint8_t> first_acts_first;
    for (const Joint& joint : skeleton.joints()) {
        names.push_back(joint.name);
        channels.push_back(channels_text(joint));
        parents.push_back(joint.parent);
        first_acts_first.push_back(joint.first_rotation_acts_first);
    }
    file_.write_texts(constant(at.joint("name"), ElementType::text, "1", "joint names"), names);
    file_.write_texts(constant(at.joint("channels"), ElementType::text, "1",
                               "degrees of freedom of each joint, in column order"),
                      channels);
    file_.write_texts(
        constant(at.joint("roles"), ElementType::text, "1", "what each joint is to the features"),
        role_texts(skeleton));
    file_.write<int32_t>(constant(at.joint("parent"), ElementType::int32, "1",
                                  "index of the parent joint, -1 for the root"),
                         parents);
    file_.write<uint8_t>(constant(at.joint("first_rotation_acts_first"), ElementType::uint8, "1",
                                  "1: rotations act in column order; 0: in reverse"),
                         first_acts_first);

    const auto rows = [&](const std::string& path, ElementType type, std::vector<int64_t> shape,
                          const char* units, const char* description, const char* frame = "") {
        file_.create({path, type, std::move(shape), units, description, "", frame, Sharding::rows});
    };
    rows(at.clip("id"), ElementType::int64, {}, "1", "clip id");
    rows(at.clip("name"), ElementType::text, {}, "1", "clip name");
    rows(at.clip("frames"), ElementType::int64, {}, "frames",
         "frames of the clip; its rows follow those of the clips before it");
    rows(at.clip("rate"), ElementType::float64, {}, "frames/s", "frame rate of the source");
    rows(at.clip("skeleton"), ElementType::text, {}, "1", "name of the clip's skeleton");
    rows(at.clip("offset_before"), ElementType::float64, {joints, 3}, "cm",
         "from the parent to the joint, before the joint turns", "parent joint");
    rows(at.clip("offset_after"), ElementType::float64, {joints, 3}, "cm",
         "from the pivot to the joint, turning with it (ASF bones)", "own joint");
    rows(at.clip("axes"), ElementType::float64, {joints, 3, 3}, "1",
         "axes the joint turns about, as columns", "parent joint");
    rows(at.motion(), ElementType::float32, {skeleton.dof_count()}, "cm, rad",
         "degrees of freedom: joints in order, channels in order", "parent joint");
    rows(at.positions(), ElementType::float32, {joints, 3}, "cm", "joint positions", "world, Y up");
}

void FrameShardWriter::add(const StoredClip& stored) {
    const Skeleton& skeleton = *stored.clip.skeleton;
    const std::string name = skeleton.class_name();
    if (classes_[name]++ == 0) begin_class(name, skeleton);
    const Paths at(name);

    std::vector<Eigen::Vector3d> before, after;
    std::vector<double> axes;
    for (const Joint& joint : skeleton.joints()) {
        before.push_back(joint.offset_before);
        after.push_back(joint.offset_after);
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) axes.push_back(joint.axes(row, column));
        }
    }
    const int64_t id = clip_id(stored.name), frames = stored.clip.frames();
    file_.append<int64_t>(at.clip("id"), {&id, 1});
    file_.append_texts(at.clip("name"), {&stored.name, 1});
    file_.append<int64_t>(at.clip("frames"), {&frames, 1});
    file_.append<double>(at.clip("rate"), {&stored.clip.rate, 1});
    file_.append_texts(at.clip("skeleton"), {&skeleton.name(), 1});
    file_.append<double>(at.clip("offset_before"), flatten(before));
    file_.append<double>(at.clip("offset_after"), flatten(after));
    file_.append<double>(at.clip("axes"), axes);
    file_.append(at.motion(), stored.clip.motion);
    file_.append(at.positions(), stored.positions);
}

ArtifactRecord FrameShardWriter::close() {
    return file_.close();
}

FrameShardReader::FrameShardReader(ArtifactReader file) : file_(std::move(file)) {
    for (const std::string& group : groups_with(file_, "/clips/name")) {
        const std::string clip_class = group.substr(1);
        const Paths at(clip_class);
        const auto names = file_.read_texts(at.clip("name"));
        const auto frames = file_.read<int64_t>(at.clip("frames"));
        const auto rates = file_.read<double>(at.clip("rate"));
        int64_t row = 0;
        for (size_t i = 0; i < names.size(); ++i) {
            clips_.push_back({names[i], clip_class, row, frames[i], rates[i]});
            row += frames[i];
        }
    }
    // Classes are read one after another; callers see one list in name order.
    std::map<std::string, int64_t> seen;
    std::vector<std::pair<FrameShardClip, int64_t>> places;
    for (FrameShardClip& clip : clips_) {
        const int64_t row = seen[clip.clip_class]++;
        places.emplace_back(std::move(clip), row);
    }
    std::sort(places.begin(), places.end(),
              [](const auto& a, const auto& b) { return a.first.name < b.first.name; });
    clips_.clear();
    for (auto& [clip, row] : places) {
        clips_.push_back(std::move(clip));
        row_in_class_.push_back(row);
    }
}

StoredClip FrameShardReader::read(size_t i) const {
    const FrameShardClip& place = clips_[i];
    const int64_t row = row_in_class_[i];
    const Paths at(place.clip_class);

    const auto names = file_.read_texts(at.joint("name"));
    const auto channels = file_.read_texts(at.joint("channels"));
    const auto parents = file_.read<int32_t>(at.joint("parent"));
    const auto first_acts_first = file_.read<uint8_t>(at.joint("first_rotation_acts_first"));
    const auto before = file_.read<double>(at.clip("offset_before"), row, 1);
    const auto after = file_.read<double>(at.clip("offset_after"), row, 1);
    const auto axes = file_.read<double>(at.clip("axes"), row, 1);

    std::vector<Joint> joints(names.size());
    for (size_t j = 0; j < joints.size(); ++j) {
        joints[j].name = names[j];
        joints[j].parent = parents[j];
        joints[j].channels = parse_channels(channels[j]);
        joints[j].first_rotation_acts_first = first_acts_first[j];
        joints[j].offset_before = vector_at(before, j);
        joints[j].offset_after = vector_at(after, j);
        joints[j].axes =
            Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(axes.data() + 9 * j);
    }
    auto skeleton = std::make_shared<Skeleton>(
        file_.read_texts(at.clip("skeleton"))[static_cast<size_t>(row)], std::move(joints));
    set_roles(*skeleton, file_.read_texts(at.joint("roles")));

    StoredClip stored;
    stored.name = place.name;
    stored.clip.rate = place.rate;
    stored.clip.motion = file_.read_matrix(at.motion(), place.first_row, place.frames);
    stored.clip.skeleton = std::move(skeleton);
    stored.positions = file_.read_matrix(at.positions(), place.first_row, place.frames);
    return stored;
}

}  // namespace kinetome
