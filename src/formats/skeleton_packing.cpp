#include "kinetome/formats/skeleton_packing.h"

#include <stdexcept>

namespace kinetome {
namespace {

template <class Values>
void put_all(Packer& out, const Values& values) {
    out.put(std::span<const double>(values.data(), static_cast<size_t>(values.size())));
}

template <class Values>
void get_all(Unpacker& in, Values& values) {
    const auto all = in.get_all<double>();
    if (static_cast<Eigen::Index>(all.size()) != values.size()) {
        throw std::out_of_range("packed bytes are not a joint");
    }
    values = Eigen::Map<const Values>(all.data());
}

}  // namespace

void pack(Packer& out, const Skeleton& skeleton) {
    out.put(std::string_view(skeleton.name()));
    out.put(static_cast<uint64_t>(skeleton.joints().size()));
    for (const Joint& joint : skeleton.joints()) {
        out.put(std::string_view(joint.name)).put<int32_t>(joint.parent);
        put_all(out, joint.offset_before);
        put_all(out, joint.offset_after);
        put_all(out, joint.axes);
        std::string channels;
        for (const Channel channel : joint.channels) channels += static_cast<char>(channel);
        out.put(std::string_view(channels)).put<uint8_t>(joint.first_rotation_acts_first);
    }
    for (int role = 0; role < joint_role_count; ++role) {
        out.put<int32_t>(skeleton.role(static_cast<JointRole>(role)));
    }
}

void unpack(Unpacker& in, Skeleton& skeleton) {
    std::string name = in.get_text();
    std::vector<Joint> joints;
    for (auto left = in.get<uint64_t>(); left > 0; --left) {
        Joint& joint = joints.emplace_back();
        joint.name = in.get_text();
        joint.parent = in.get<int32_t>();
        get_all(in, joint.offset_before);
        get_all(in, joint.offset_after);
        get_all(in, joint.axes);
        for (const char channel : in.get_text()) {
            if (channel < 0 || channel > static_cast<char>(Channel::rz)) {
                throw std::out_of_range("packed bytes are not a joint");
            }
            joint.channels.push_back(static_cast<Channel>(channel));
        }
        joint.first_rotation_acts_first = in.get<uint8_t>() != 0;
    }
    const auto count = static_cast<int32_t>(joints.size());
    try {
        skeleton = Skeleton(std::move(name), std::move(joints));
    } catch (const std::invalid_argument& error) {
        throw std::out_of_range(error.what());
    }
    for (int role = 0; role < joint_role_count; ++role) {
        const auto joint = in.get<int32_t>();
        if (joint < -1 || joint >= count) throw std::out_of_range("packed bytes are no skeleton");
        skeleton.set_role(static_cast<JointRole>(role), joint);
    }
}

}  // namespace kinetome
