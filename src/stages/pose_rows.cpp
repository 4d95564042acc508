#include "kinetome/stages/pose_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <regex>

namespace kinetome {
namespace {

std::optional<std::regex> subject_pattern(const PartitionOptions& options) {
    if (options.subject_from.empty()) return std::nullopt;
    return std::regex(options.subject_from);
}

/// A subject as the name of an HDF5 group: everything but letters, digits, '-' and '_' as %XX.
std::string group_name(const std::string& subject) {
    std::string name = "subject-";
    for (const char c : subject) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '-' || c == '_';
        name += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return name;
}

void lay_out(const Survey& survey, PosePartition& partition) {
    std::vector<ClipExtent> extents = survey.extents();
    size_t take = 0;
    int64_t row = 0;
    for (PartitionClip& clip : partition.clips) {
        while (survey.takes[take].name != clip.place.name) ++take;
        clip.first_row = row;
        extents[take].rows = clip.place.pose_rows;
        row += clip.place.pose_rows;
    }
    partition.layout = layout_pieces(extents);
}

/// Rows of a partition that read(clip, first row in its shard, count) brings, clip by clip.
template <class Read>
MatrixF read_clips(const std::vector<PartitionClip>& clips, const RowRange& range,
                   const Read& read_clip) {
    auto clip =
        std::upper_bound(clips.begin(), clips.end(), range.first,
                         [](int64_t row, const PartitionClip& c) { return row < c.first_row; });
    --clip;
    MatrixF rows;
    for (int64_t done = 0; done < range.size(); ++clip) {
        const int64_t skip = range.first + done - clip->first_row;
        const int64_t count = std::min(clip->place.pose_rows - skip, range.size() - done);
        if (count <= 0) continue;  // a clip without rows
        const MatrixF part = read_clip(*clip, clip->place.first_pose_row + skip, count);
        if (!rows.size()) rows.resize(range.size(), part.cols());
        rows.middleRows(done, count) = part;
        done += count;
    }
    return rows;
}

using ClassClips = std::map<std::string, std::vector<PartitionClip>>;

/// Clips in name order, by class.
ClassClips clips_by_class(const StageContext& context,
                          const std::vector<const FinishedWork*>& features) {
    ClassClips classes;
    for (const FinishedWork* work : features) {
        const auto shard =
            std::make_shared<const FeatureShardReader>(context.workspace.open(*work));
        for (const FeatureShardClip& clip : shard->clips()) {
            classes[clip.clip_class].push_back({clip, shard, 0});
        }
    }
    return classes;
}

}  // namespace

MatrixF PosePartition::read(const RowRange& range) const {
    return read_clips(clips, range, [](const PartitionClip& clip, int64_t first, int64_t count) {
        return clip.shard->pose_vectors(clip.place.clip_class, first, count);
    });
}

MatrixF PosePartition::read_markers(const RowRange& range) const {
    return read_clips(clips, range, [](const PartitionClip& clip, int64_t first, int64_t count) {
        return clip.shard->markers(clip.place.clip_class, first, count);
    });
}

FeatureClass PosePartition::feature_class() const {
    return clips.front().shard->feature_class(clip_class);
}

std::vector<PosePartition> pose_partitions(const StageContext& context,
                                           const std::vector<const FinishedWork*>& features) {
    ClassClips classes = clips_by_class(context, features);
    std::map<std::string, std::string> source_of;
    for (const Take& take : context.survey.takes) source_of[take.name] = take.source;

    const PartitionOptions& options = context.options.partition;
    const auto pattern = subject_pattern(options);
    std::map<std::string, PosePartition> partitions;
    for (auto& [clip_class, clips] : classes) {
        int64_t rows = 0;
        for (const PartitionClip& clip : clips) rows += clip.place.pose_rows;
        const bool by_subject = partition_by_subject(options.rule, rows);
        for (PartitionClip& clip : clips) {
            const std::string part =
                by_subject ? group_name(subject_of(source_of.at(clip.place.name), pattern)) : "all";
            PosePartition& partition = partitions["/" + clip_class + "/" + part];
            partition.clip_class = clip_class;
            partition.clips.push_back(std::move(clip));
        }
    }
    std::vector<PosePartition> result;
    for (auto& [path, partition] : partitions) {
        partition.path = path;
        lay_out(context.survey, partition);
        result.push_back(std::move(partition));
    }
    return result;
}

std::vector<PosePartition> class_partitions(const StageContext& context,
                                            const std::vector<const FinishedWork*>& features) {
    std::vector<PosePartition> result;
    for (auto& [clip_class, clips] : clips_by_class(context, features)) {
        PosePartition partition{clip_class, "/" + clip_class, std::move(clips), {}};
        lay_out(context.survey, partition);
        result.push_back(std::move(partition));
    }
    return result;
}

Digest subjects_digest(const Survey& survey, const PartitionOptions& options) {
    Hasher hasher;
    if (options.rule == PartitionRule::none) return hasher.finish();
    const auto pattern = subject_pattern(options);
    for (const Take& take : survey.takes) {
        hasher.text(take.name).text(subject_of(take.source, pattern));
    }
    return hasher.finish();
}

}  // namespace kinetome
