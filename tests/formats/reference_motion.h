// A second, independent way from ASF/AMC and BVH text to joint positions: its own reading of the
// text, Hamilton quaternions instead of matrices, recursion instead of a loop. Shares no code with
// the library, so that an error in one shows.
#pragma once

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace reference {

struct Vector {
    double x = 0, y = 0, z = 0;
};
inline Vector operator+(Vector a, Vector b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector operator*(double s, Vector a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline double distance(Vector a, Vector b) {
    return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) +
                     (a.z - b.z) * (a.z - b.z));
}

struct Quaternion {
    double w = 1, x = 0, y = 0, z = 0;
    Quaternion conjugate() const { return {w, -x, -y, -z}; }
};
inline Quaternion operator*(Quaternion a, Quaternion b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
            a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
inline Vector rotate(Quaternion q, Vector v) {
    const Quaternion turned = q * Quaternion{0, v.x, v.y, v.z} * q.conjugate();
    return {turned.x, turned.y, turned.z};
}
inline Quaternion about(char axis, double degrees) {
    const double half = degrees * std::numbers::pi / 360.0;
    const double s = std::sin(half);
    return {std::cos(half), axis == 'x' ? s : 0, axis == 'y' ? s : 0, axis == 'z' ? s : 0};
}
/// The angle of the rotation between two, in degrees.
inline double degrees_between(Quaternion a, Quaternion b) {
    const Quaternion d = a * b.conjugate();
    return 360.0 / std::numbers::pi * std::atan2(std::hypot(d.x, d.y, d.z), std::abs(d.w));
}

struct Placed {
    Vector end;
    Quaternion rotation;
};
using Frame = std::map<std::string, std::vector<double>>;  ///< numbers of a line, by bone
using Placing = std::map<std::string, Placed>;

struct AsfBone {
    Vector direction;
    double length = 0;
    Quaternion axis;
    std::string freedom;  ///< "xz" for rx rz
};

/// CMU's shape only: degrees, axis order XYZ, root TX TY TZ RX RY RZ.
class Asf {
  public:
    explicit Asf(const std::string& text) {
        std::istringstream lines(text);
        std::string line, name, section;
        double unit = 1;
        while (std::getline(lines, line)) {
            std::istringstream words(line);
            std::string word;
            if (!(words >> word)) continue;
            if (word[0] == ':') section = word;
            AsfBone& bone = bones_[name];
            if (section == ":units" && word == "length") words >> unit;
            if (section == ":bonedata") {
                if (word == "name") words >> name;
                if (word == "direction") {
                    words >> bone.direction.x >> bone.direction.y >> bone.direction.z;
                }
                if (word == "length") words >> bone.length;
                if (word == "axis") {
                    double x = 0, y = 0, z = 0;
                    words >> x >> y >> z;
                    bone.axis = about('z', z) * about('y', y) * about('x', x);
                }
                if (word == "dof") {
                    while (words >> word) bone.freedom += word[1];
                }
            }
            if (section == ":hierarchy" && word != "begin" && word != "end") {
                std::string child;
                while (words >> child) children_[word].push_back(child);
            }
        }
        cm_ = 2.54 / unit;
    }

    Placing place(const Frame& frame) const {
        const std::vector<double>& root = frame.at("root");
        const Vector position = cm_ * Vector{root[0], root[1], root[2]};
        const Quaternion rotation = about('z', root[5]) * about('y', root[4]) * about('x', root[3]);
        Placing placing = {{"root", {position, rotation}}};
        place_children("root", frame, placing);
        return placing;
    }

  private:
    void place_children(const std::string& parent, const Frame& frame, Placing& placing) const {
        const auto children = children_.find(parent);
        if (children == children_.end()) return;
        for (const std::string& name : children->second) {
            const AsfBone& bone = bones_.at(name);
            Quaternion turn;
            for (size_t i = 0; i < bone.freedom.size(); ++i) {
                turn = about(bone.freedom[i], frame.at(name)[i]) * turn;
            }
            const Placed& from = placing.at(parent);
            const Quaternion rotation = from.rotation * bone.axis * turn * bone.axis.conjugate();
            const Vector along = (bone.length * cm_) * bone.direction;
            placing[name] = {from.end + rotate(rotation, along), rotation};
            place_children(name, frame, placing);
        }
    }

    std::map<std::string, AsfBone> bones_;
    std::map<std::string, std::vector<std::string>> children_;
    double cm_ = 1;
};

inline std::vector<Frame> amc_frames(const std::string& text) {
    std::vector<Frame> frames;
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        std::string name;
        if (!(words >> name) || name[0] == '#' || name[0] == ':') continue;
        if (std::isdigit(static_cast<unsigned char>(name[0]))) {
            frames.emplace_back();
            continue;
        }
        double value = 0;
        while (words >> value) frames.back()[name].push_back(value);
    }
    return frames;
}

/// Plays a BVH text: where each joint begins (positions) and each End Site lies, by the name of the
/// joint it ends. `end` of a Placed is where the joint begins; End Sites are "<joint> end".
inline std::vector<Placing> bvh_frames(const std::string& text) {
    struct Joint {
        std::string name;
        int parent = -1;
        Vector offset;
        std::vector<std::string> channels;
    };
    std::istringstream words(text);
    std::string word;
    std::vector<Joint> joints;
    std::vector<int> open;
    while (words >> word && word != "MOTION") {
        if (word == "ROOT" || word == "JOINT" || word == "End") {
            const int parent = open.empty() ? -1 : open.back();
            std::string name;
            words >> name;
            if (word == "End") name = joints[static_cast<size_t>(parent)].name + " end";
            joints.push_back({name, parent, {}, {}});
        } else if (word == "{") {
            open.push_back(static_cast<int>(joints.size()) - 1);
        } else if (word == "}") {
            open.pop_back();
        } else if (word == "OFFSET") {
            Vector& offset = joints.back().offset;
            words >> offset.x >> offset.y >> offset.z;
        } else if (word == "CHANNELS") {
            size_t count = 0;
            words >> count;
            joints.back().channels.resize(count);
            for (std::string& channel : joints.back().channels) words >> channel;
        }
    }
    size_t frame_count = 0;
    double frame_time = 0;
    words >> word >> frame_count >> word >> word >> frame_time;
    std::vector<Placing> frames(frame_count);
    for (Placing& frame : frames) {
        for (const Joint& joint : joints) {
            Vector position = joint.offset;
            Quaternion turn;
            for (const std::string& channel : joint.channels) {
                double value = 0;
                words >> value;
                if (channel == "Xposition") position.x = value;
                if (channel == "Yposition") position.y = value;
                if (channel == "Zposition") position.z = value;
                const char axis = static_cast<char>(channel[0] - 'X' + 'x');
                if (channel.ends_with("rotation")) turn = turn * about(axis, value);
            }
            Placed placed{position, turn};
            if (joint.parent >= 0) {
                const Placed& from = frame.at(joints[static_cast<size_t>(joint.parent)].name);
                placed.end = from.end + rotate(from.rotation, position);
                placed.rotation = from.rotation * turn;
            }
            frame[joint.name] = placed;
        }
    }
    return words ? frames : std::vector<Placing>();
}

}  // namespace reference
