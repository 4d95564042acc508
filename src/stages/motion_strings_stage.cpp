// motion_strings: every take as the letters it passes through, and which letters are close enough
// to be equal (S1 §3.2, §3.6).
#include <algorithm>

#include "kinetome/base/pack_fields.h"
#include "kinetome/models/motion_string.h"
#include "kinetome/models/pose_clusters.h"
#include "kinetome/stages/pose_cluster_file.h"
#include "kinetome/stages/pose_rows.h"
#include "kinetome/stages/projected_rows.h"
#include "kinetome/stages/stage.h"
#include "kinetome/stages/work_share.h"
#include "kinetome/store/catalog.h"

namespace kinetome {
namespace {

struct PartitionString {
    MotionString string;
    AccessibilityMatrix accessibility;
    double tau = 0;
    int64_t lambda = 0;
};

void pack(Packer& out, const PartitionString& spelled) {
    pack_all(out, spelled.string, spelled.accessibility, spelled.tau, spelled.lambda);
}

void unpack(Unpacker& in, PartitionString& spelled) {
    unpack_all(in, spelled.string, spelled.accessibility, spelled.tau, spelled.lambda);
}

/// Of a partition that all ranks work on, rank 0 has the result.
PartitionString spell(const StageContext& context, const PosePartition& partition,
                      const StoredPoseClusters& model, const Workers& workers) {
    const MotionStringOptions& options = context.options.motion_strings;
    const KeptRows rows = projected_rows(partition, model.pca, workers, 0, context.stop);
    const std::vector<int32_t> letters = likeliest_clusters(model.mixture, rows, workers);
    PartitionString result;
    if (!workers.is_root()) return result;
    std::vector<int64_t> frames;
    for (const PartitionClip& clip : partition.clips) frames.push_back(clip.place.pose_rows);
    result.string = make_motion_string(letters, frames);
    result.tau = options.tau > 0
                     ? options.tau
                     : adjacent_distance(result.string, model.mixture, options.tau_quantile);
    result.accessibility = accessibility(model.mixture, result.tau, workers.threads);
    result.lambda = longest_substring(
        result.string, options.longest_submotion * context.options.features.pose_rate);
    return result;
}

void write(ArtifactWriter& file, const PosePartition& partition, const PartitionString& spelled) {
    const auto spec = [&](const char* name, ElementType type, const char* units,
                          const char* description, const char* source,
                          std::vector<int64_t> shape = {}) {
        return DatasetSpec{partition.path + "/" + name,
                           type,
                           std::move(shape),
                           units,
                           description,
                           source,
                           "",
                           {}};
    };
    std::vector<int64_t> ids, pose_rows, source_frames;
    std::vector<std::string> names;
    std::vector<double> rates;
    for (const PartitionClip& clip : partition.clips) {
        ids.push_back(clip_id(clip.place.name));
        names.push_back(clip.place.name);
        pose_rows.push_back(clip.place.pose_rows);
        source_frames.push_back(clip.place.source_frames);
        rates.push_back(clip.place.source_rate);
    }
    file.write<int64_t>(spec("clips/id", ElementType::int64, "1", "clip id", ""), ids);
    file.write_texts(spec("clips/name", ElementType::text, "1", "clip name", ""), names);
    file.write<int64_t>(
        spec("clips/frames", ElementType::int64, "frames", "frames at the pose rate", ""),
        pose_rows);
    file.write<int64_t>(
        spec("clips/source_frames", ElementType::int64, "frames", "frames of the source", ""),
        source_frames);
    file.write<double>(
        spec("clips/source_rate", ElementType::float64, "frames/s", "frame rate of the source", ""),
        rates);

    const MotionString& string = spelled.string;
    std::vector<int64_t> clip_of_letter;
    std::vector<double> mean_frames;
    for (int64_t j = 0; j < string.size(); ++j) {
        clip_of_letter.push_back(ids[static_cast<size_t>(string.clip[static_cast<size_t>(j)])]);
        mean_frames.push_back(string.mean_frame(j));
    }
    file.write<int32_t>(spec("letters/letter", ElementType::int32, "1",
                             "s(j), repetitions collapsed inside clips", "S1 §3.2"),
                        string.letters);
    file.write<int64_t>(spec("letters/clip", ElementType::int64, "1", "clip id of each letter", ""),
                        clip_of_letter);
    file.write<int32_t>(spec("letters/first_frame", ElementType::int32, "frames",
                             "first frame of F(j) in its clip, at the pose rate", "S1 §3.2"),
                        string.first_frame);
    file.write<int32_t>(spec("letters/end_frame", ElementType::int32, "frames",
                             "end of F(j) in its clip, exclusive, at the pose rate", "S1 §3.2"),
                        string.end_frame);
    file.write<double>(spec("letters/mean_frame", ElementType::float64, "frames",
                            "mean frame of F(j) in its clip, at the pose rate", "S1 §3.2"),
                       mean_frames);
    const AccessibilityMatrix& a = spelled.accessibility;
    file.write<uint64_t>(
        spec("accessibility", ElementType::uint64, "1",
             "A[a, b]: bit b % 64 of word b / 64 of row a", "S1 Eq. 2", {a.words_per_row()}),
        a.words());
    const double pose_rate = partition.feature_class().pose_rate;
    file.write<double>(
        spec("pose_rate", ElementType::float64, "frames/s", "rate that frames count at", ""),
        std::span(&pose_rate, 1));
    file.write<double>(
        spec("tau", ElementType::float64, "1", "distance below which letters are equal", "S1 §3.6"),
        std::span(&spelled.tau, 1));
    file.write<int64_t>(
        spec("lambda", ElementType::int64, "letters", "longest substring", "S1 Eq. 7"),
        std::span(&spelled.lambda, 1));
}

}  // namespace

StageResult make_motion_strings(const StageContext& context, const StageTask& task) {
    const ArtifactReader models = context.workspace.open(*task.inputs_of("pose_clusters").front());
    auto partitions = pose_partitions(context, task.inputs_of("features"));
    std::erase_if(partitions, [&](const PosePartition& partition) {  // skipped there, with a reason
        return !models.contains(partition.path + "/means");
    });
    const auto spelled = for_partitions<PartitionString>(
        context.workers(), partitions, [&](size_t i, const Workers& workers) {
            return spell(context, partitions[i], read_pose_clusters(models, partitions[i].path),
                         workers);
        });
    StageResult result;
    if (!context.is_root()) return result;
    ArtifactWriter file(task.output, task.header, context.writing());
    for (size_t i = 0; i < partitions.size(); ++i) {
        write(file, partitions[i], spelled[i]);
        const int64_t letters = spelled[i].string.size();
        context.log.info("motion_strings {}: {} letters, {:.1f} frames a letter, τ {:.2f}, λ {}",
                         partitions[i].path, letters,
                         static_cast<double>(partitions[i].rows()) /
                             static_cast<double>(std::max<int64_t>(1, letters)),
                         spelled[i].tau, spelled[i].lambda);
    }
    result.file = file.close();
    return result;
}

}  // namespace kinetome
