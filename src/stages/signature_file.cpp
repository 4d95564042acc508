#include "kinetome/stages/signature_file.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

#include "group_writer.h"
#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/formats/resample.h"
#include "kinetome/store/catalog.h"
#include "kinetome/store/groups.h"

namespace kinetome {
namespace {

const std::string rate_path = "/pose_rate";
const std::string samples_path = "/samples/position";

template <class Value>
std::vector<int64_t> lengths_of(const ValueLists<Value>& lists) {
    std::vector<int64_t> lengths;
    for (int64_t i = 0; i < lists.size(); ++i) {
        lengths.push_back(static_cast<int64_t>(lists[i].size()));
    }
    return lengths;
}

std::vector<int64_t> first_of_each(const std::vector<int64_t>& lengths) {
    std::vector<int64_t> first{0};
    for (const int64_t length : lengths) first.push_back(first.back() + length);
    return first;
}

/// One member of each value.
template <class Member, class Value>
std::vector<Member> column(const std::vector<Value>& values, Member Value::*member) {
    std::vector<Member> found;
    for (const Value& value : values) found.push_back(value.*member);
    return found;
}

void write_clips(const GroupWriter& out, const ClassSignatures& signatures) {
    std::vector<int64_t> ids;
    for (const SignatureClip& clip : signatures.clips) ids.push_back(clip_id(clip.name));
    out.values<int64_t>("clips/id", "1", "clip id", "", ids);
    out.texts("clips/name", "clip name", "", column(signatures.clips, &SignatureClip::name));
    out.values<int64_t>("clips/frames", "frames", "frames at the pose rate", "",
                        column(signatures.clips, &SignatureClip::frames));
    out.values<int64_t>("clips/source_frames", "frames", "frames of the source", "",
                        column(signatures.clips, &SignatureClip::source_frames));
    out.values<double>("clips/source_rate", "frames/s", "frame rate of the source", "",
                       column(signatures.clips, &SignatureClip::source_rate));
    out.values<int64_t>("clips/runs", "1", "runs of the clip's signature", "S2 §5.3",
                        lengths_of(signatures.index.parts().clips));
}

std::vector<SignatureClip> read_clips(const ArtifactReader& file, const std::string& group) {
    const auto names = file.read_texts(group + "/clips/name");
    const auto frames = file.read<int64_t>(group + "/clips/frames");
    const auto source_frames = file.read<int64_t>(group + "/clips/source_frames");
    const auto rates = file.read<double>(group + "/clips/source_rate");
    std::vector<SignatureClip> clips;
    for (size_t i = 0; i < names.size(); ++i) {
        clips.push_back({names[i], frames[i], source_frames[i], rates[i]});
    }
    return clips;
}

SignatureIndex::Parts read_parts(const ArtifactReader& file, const std::string& group) {
    const auto at = [&](const char* name) { return group + "/" + name; };
    SignatureIndex::Parts parts;
    parts.clips.first = first_of_each(file.read<int64_t>(at("clips/runs")));
    const auto leaves = file.read<int32_t>(at("runs/leaf"));
    const auto firsts = file.read<int32_t>(at("runs/first_frame"));
    const auto frames = file.read<int32_t>(at("runs/frames"));
    for (size_t i = 0; i < leaves.size(); ++i) {
        parts.clips.values.push_back({leaves[i], firsts[i], frames[i]});
    }
    parts.positions = file.read_matrix(at("runs/position"));
    parts.stride = file.read<int32_t>(at("samples/stride")).at(0);
    parts.sample_positions = file.read_matrix(at("samples/position"));
    parts.occurrences.first = first_of_each(file.read<int64_t>(at("leaves/occurrences")));
    parts.occurrences.values = file.read<int32_t>(at("occurrences/run"));
    parts.near_leaves.first = first_of_each(file.read<int64_t>(at("leaves/near_leaves")));
    const auto near = file.read<int32_t>(at("near_leaves/leaf"));
    const auto distances = file.read<float>(at("near_leaves/distance"));
    for (size_t i = 0; i < near.size(); ++i) {
        parts.near_leaves.values.push_back({near[i], distances[i]});
    }
    parts.reach = file.read<double>(at("reach")).at(0);
    return parts;
}

}  // namespace

int64_t ClassSignatures::source_boundary(int32_t clip, int64_t frame) const {
    const SignatureClip& of = clips[static_cast<size_t>(clip)];
    if (frame >= of.frames) return of.source_frames;
    return static_cast<int64_t>(std::ceil(source_frame(frame, of.source_rate, pose_rate)));
}

void write_signatures(ArtifactWriter& file, const std::string& group,
                      const ClassSignatures& signatures) {
    const SignatureIndex::Parts& parts = signatures.index.parts();
    const auto& runs = parts.clips.values;
    const auto& near = parts.near_leaves.values;
    const GroupWriter out(file, group);
    out.values<double>("pose_rate", "frames/s", "rate that frames count at", "",
                       {signatures.pose_rate});
    out.rows("axes", "mm/cm", "what poses are multiplied by for positions", "", signatures.axes);
    write_clips(out, signatures);
    out.values<int32_t>("runs/leaf", "1", "leaf of the pose hierarchy, clip after clip", "S2 §5.3",
                        column(runs, &SignatureRun::leaf));
    out.values<int32_t>("runs/first_frame", "frames", "first frame of the run in its clip",
                        "S2 §5.3", column(runs, &SignatureRun::first_frame));
    out.values<int32_t>("runs/frames", "frames", "frames of the run", "S2 §5.3",
                        column(runs, &SignatureRun::frames));
    out.rows("runs/position", "mm", "Euclidean distances are those between mean poses, per marker",
             "", parts.positions);
    out.values<int32_t>("samples/stride", "frames", "from one sample of a clip to the next", "",
                        {parts.stride});
    out.rows("samples/position", "mm", "likewise of poses, clip after clip", "",
             parts.sample_positions);
    out.values<int64_t>("leaves/occurrences", "1", "runs of the leaf", "S2 §5.3",
                        lengths_of(parts.occurrences));
    out.values<int32_t>("occurrences/run", "1", "rows of runs, leaf after leaf", "S2 §5.3",
                        parts.occurrences.values);
    out.values<int64_t>("leaves/near_leaves", "1", "leaves listed as near to it", "",
                        lengths_of(parts.near_leaves));
    out.values<int32_t>("near_leaves/leaf", "1", "leaves near each leaf, nearest first", "",
                        column(near, &NearLeaf::leaf));
    out.values<float>("near_leaves/distance", "mm", "from the leaf, per marker", "",
                      column(near, &NearLeaf::distance));
    out.values<double>("reach", "mm", "leaves farther apart are not near, per marker", "",
                       {parts.reach});
}

ClassSignatures read_signatures(const ArtifactReader& file, const std::string& group) {
    if (!file.contains(group + rate_path)) {
        throw StoreError(fmt::format("{} holds no signatures of class {}",
                                     path_for_message(file.path().string()), group.substr(1)));
    }
    if (!file.contains(group + samples_path)) {
        throw StoreError(
            fmt::format("{} was made by an earlier version of kinetome, without what queries are "
                        "compared by; kinetome reindex makes it again",
                        path_for_message(file.path().string())));
    }
    try {
        return {file.read<double>(group + rate_path).at(0), read_clips(file, group),
                file.read_matrix(group + "/axes"), SignatureIndex(read_parts(file, group))};
    } catch (const std::invalid_argument& error) {
        throw StoreError(
            fmt::format("{}: {}", path_for_message(file.path().string()), error.what()));
    }
}

std::vector<std::string> signature_classes(const ArtifactReader& file) {
    return groups_with(file, rate_path);
}

}  // namespace kinetome
