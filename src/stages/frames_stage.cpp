// frames: read → parse → kinematics → write, as a pipeline with a bounded number of takes in it.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "clip_pipeline.h"
#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/progress.h"
#include "kinetome/base/quote.h"
#include "kinetome/formats/asf_amc.h"
#include "kinetome/formats/joint_roles.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/take_format.h"
#include "kinetome/stages/stage.h"
#include "kinetome/store/frame_store.h"

namespace kinetome {
namespace {

/// Memory that a take needs between being read and being written, per byte of its source.
constexpr uint64_t working_bytes_per_source_byte = 4;

/// The survey could read the file, so a failure now is the disk's, not the take's: it must not be
/// remembered as the take's under the key of its content.
std::string read_again(const Survey& survey, const std::string& source) {
    try {
        return read_source_file(survey.corpus / source);
    } catch (const InputError& error) {
        throw StoreError(fmt::format("{}; it could be read when the run began: {}", error.what(),
                                     survey.remedy_for_change));
    }
}

/// A skeleton file, parsed once and shared by its takes; the error is kept for each of them.
class SkeletonFiles {
  public:
    SkeletonFiles(const StageContext& context) : context_(context) {
        const std::string& map = context.options.frames.joint_map;
        if (!map.empty()) joint_map_ = load_joint_map(map);
    }

    /// Parsed skeleton with roles and the digest of its bytes. Throws InputError.
    struct Entry {
        std::shared_ptr<const Skeleton> skeleton;
        Digest content;
        std::string error;
    };
    const Entry& get(const std::string& source) {
        const std::lock_guard lock(mutex_);
        const auto [found, is_new] = entries_.try_emplace(source);
        if (is_new) load(source, found->second);
        return found->second;
    }
    /// A copy of a skeleton whose joints have their roles. Throws InputError.
    std::shared_ptr<const Skeleton> with_roles(const Skeleton& skeleton,
                                               const std::string& path) const {
        auto copy = std::make_shared<Skeleton>(skeleton);
        assign_roles(*copy, path, joint_map_ ? &*joint_map_ : nullptr);
        return copy;
    }

  private:
    void load(const std::string& source, Entry& entry) {
        try {
            const std::string bytes = read_again(context_.survey, source);
            entry.content = digest_of(bytes);
            const std::string path = path_for_message(source);
            entry.skeleton = with_roles(parse_asf(bytes, path), path);
        } catch (const InputError& error) {
            entry.error = error.what();
        }
    }

    const StageContext& context_;
    std::optional<JointMap> joint_map_;
    std::mutex mutex_;
    std::map<std::string, Entry> entries_;
};

/// One take on its way through the pipeline.
struct Passenger {
    const Take* take = nullptr;
    std::optional<StoredClip> clip;
    ClipOutcome outcome;
};

std::vector<std::string> capabilities_of(const Skeleton& skeleton) {
    std::vector<std::string> capabilities;
    if (skeleton.dof_count() > 0) capabilities.push_back("angles");
    if (skeleton.role(JointRole::head) >= 0) capabilities.push_back("effectors");
    capabilities.push_back("markers");
    return capabilities;
}

void check_unchanged(const Survey& survey, const Take& take, const std::string& bytes,
                     const Digest& skeleton) {
    if (content_digest(bytes, skeleton) == take.content) return;
    throw StoreError(fmt::format("{}: changed since the run began: {}",
                                 path_for_message(take.source), survey.remedy_for_change));
}

void parse(const StageContext& context, SkeletonFiles& skeletons, Passenger& passenger) {
    const Take& take = *passenger.take;
    passenger.outcome.clip = take.name;
    try {
        const std::string bytes = read_again(context.survey, take.source);
        const TakeFormat& format =
            *find_take_format(std::filesystem::path(take.source).extension().string());
        TakeSource source{.bytes = bytes,
                          .path = path_for_message(take.source),
                          .skeleton = nullptr,
                          .default_rate = context.options.frames.amc.rate};
        Digest skeleton_content;
        const SkeletonFiles::Entry* entry = nullptr;
        if (!take.skeleton_source.empty()) {
            entry = &skeletons.get(take.skeleton_source);
            skeleton_content = entry->content;
        }
        check_unchanged(context.survey, take, bytes, skeleton_content);
        if (entry) {
            if (!entry->skeleton) throw InputError(entry->error);
            source.skeleton = entry->skeleton;
        }
        StoredClip stored{take.name, format.parse(source), {}};
        if (!source.skeleton) {
            stored.clip.skeleton = skeletons.with_roles(*stored.clip.skeleton, source.path);
        }
        stored.positions = joint_positions(stored.clip);

        passenger.outcome.frames = stored.clip.frames();
        passenger.outcome.rate = stored.clip.rate;
        passenger.outcome.clip_class = stored.clip.skeleton->class_name();
        passenger.outcome.capabilities = capabilities_of(*stored.clip.skeleton);
        passenger.outcome.warnings = stored.clip.warnings;
        passenger.clip = std::move(stored);
    } catch (const InputError& error) {
        passenger.outcome.quarantined = error.what();
    }
}

/// Memory that the largest take of a shard needs on its way.
uint64_t largest_take(const Survey& survey, const Shard& shard) {
    uint64_t largest = 0;
    for (const size_t i : shard.clips) largest = std::max(largest, survey.takes[i].bytes);
    return largest * working_bytes_per_source_byte;
}

}  // namespace

StageResult make_frames(const StageContext& context, const StageTask& task) {
    const Shard& shard = *task.shard;
    FrameShardWriter writer(task.output, task.header, context.writing());
    SkeletonFiles skeletons(context);
    Progress progress(context.log, "frames " + shard.cut, shard.claimed_frames, "frames");
    StageResult result;

    auto next = shard.clips.begin();
    const auto read = [&]() -> std::shared_ptr<Passenger> {
        while (next != shard.clips.end() && !context.survey.takes[*next].quarantined.empty()) {
            ++next;
        }
        if (next == shard.clips.end()) return nullptr;
        return std::make_shared<Passenger>(Passenger{&context.survey.takes[*next++], {}, {}});
    };
    const auto work = [&](Passenger& passenger) { parse(context, skeletons, passenger); };
    const auto write = [&](Passenger& passenger) {
        if (passenger.clip) writer.add(*passenger.clip);
        result.clips.push_back(std::move(passenger.outcome));
        progress.advance(passenger.take->claimed_frames);
    };
    run_clip_pipeline<Passenger>(
        clips_in_flight(context.resources, largest_take(context.survey, shard)), context.stop, read,
        work, write);
    result.file = writer.close();
    return result;
}

}  // namespace kinetome
