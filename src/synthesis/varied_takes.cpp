// Takes of another corpus, varied until there are frames enough.
#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/formats/asf_amc.h"
#include "kinetome/formats/joint_roles.h"
#include "kinetome/formats/resample.h"
#include "kinetome/synthesis/clip_variation.h"
#include "take_maker.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

struct SourceTake {
    fs::path skeleton;
    fs::path motion;
    int64_t frames = 0;
    auto operator<=>(const SourceTake&) const = default;
};

/// The ASF of an AMC, by the rules of `kinetome reindex`: NN.asf (NN: the stem up to its first
/// '_'), <stem>.asf, or the only one of the folder. Empty when there is none.
fs::path skeleton_of(const fs::path& motion, const std::vector<fs::path>& in_folder) {
    const std::string stem = motion.stem().string();
    for (const std::string& wanted : {stem.substr(0, stem.find('_')), stem}) {
        for (const fs::path& file : in_folder)
            if (file.stem() == wanted) return file;
    }
    return in_folder.size() == 1 ? in_folder.front() : fs::path();
}

/// In the order of skeletons, then of takes, so that a performer's takes stand together.
std::vector<SourceTake> find_takes(const fs::path& corpus) {
    std::vector<fs::path> motions;
    std::map<fs::path, std::vector<fs::path>> skeletons;
    std::error_code error;
    for (fs::recursive_directory_iterator at(corpus, error), end; !error && at != end;
         at.increment(error)) {
        const fs::path& path = at->path();
        if (path.extension() == ".amc") motions.push_back(path);
        if (path.extension() == ".asf") skeletons[path.parent_path()].push_back(path);
    }
    if (error) throw InputError::in_file(corpus.string(), "cannot be listed: " + error.message());
    std::vector<SourceTake> takes;
    for (const fs::path& motion : motions) {
        std::vector<fs::path> in_folder = skeletons[motion.parent_path()];
        std::ranges::sort(in_folder);
        const fs::path skeleton = skeleton_of(motion, in_folder);
        if (skeleton.empty()) continue;
        const int64_t frames = count_amc_frames(read_source_file(motion));
        if (frames > 0) takes.push_back({skeleton, motion, frames});
    }
    if (takes.empty())
        throw InputError::in_file(
            corpus.string(), "holds no AMC take with its ASF beside it; give a folder of takes");
    std::ranges::sort(takes);
    return takes;
}

using AnnotationsByClip = std::map<std::string, Annotations>;

/// Of truth.csv and cycles.csv at the top of the corpus, as far as they exist.
AnnotationsByClip read_annotations(const fs::path& corpus) {
    AnnotationsByClip by_clip;
    if (const fs::path file = corpus / "truth.csv"; fs::exists(file)) {
        for (const TruthRow& row : parse_truth_csv(read_source_file(file), file.string()))
            by_clip[row.clip].truth.push_back(row);
    }
    if (const fs::path file = corpus / "cycles.csv"; fs::exists(file)) {
        for (const CycleRow& row : parse_cycles_csv(read_source_file(file), file.string()))
            by_clip[row.clip].cycles.push_back(row);
    }
    return by_clip;
}

/// How a performer of the source becomes a new one.
struct Variation {
    bool mirrored = false;
    double scale = 1;
};

Variation random_variation(int64_t subject, uint64_t seed) {
    RandomStream random(seed, "variation", static_cast<uint64_t>(subject));
    const bool mirrored = random.uniform() < 0.5;
    return {mirrored, random.uniform(0.88, 1.12)};
}

struct PlannedTake {
    size_t source = 0;
    int64_t subject = 0, number = 0;
    int64_t frames = 0;
};

Clip read_clip(const SourceTake& take) {
    Skeleton skeleton = parse_asf(read_source_file(take.skeleton), take.skeleton.string());
    return parse_amc(read_source_file(take.motion), take.motion.string(),
                     std::make_shared<const Skeleton>(std::move(skeleton)));
}

Clip mirrored_take(const Clip& clip, const fs::path& skeleton) {
    try {
        return mirrored(clip);
    } catch (const std::invalid_argument& error) {
        throw InputError::in_file(skeleton.string(), error.what());
    }
}

/// Rows of a source clip as rows of the new one.
Annotations carried_over(const Annotations& source, const std::string& clip, const TimeWarp& warp,
                         bool mirrored) {
    const auto label = [&](const std::string& text) {
        return mirrored ? mirrored_label(text) : text;
    };
    Annotations result;
    for (const TruthRow& row : source.truth) {
        const TruthRow moved{.clip = clip,
                             .first = warp.frame_at(row.first),
                             .end = warp.frame_at(row.end),
                             .label = label(row.label),
                             .end_lo = warp.frame_at(row.end_lo),
                             .end_hi = warp.frame_at(row.end_hi)};
        if (moved.first < moved.end) result.truth.push_back(moved);
    }
    for (const CycleRow& row : source.cycles) {
        if (row.end > 0 && warp.frame_at(row.end - 1) == warp.frames()) continue;  // cut off
        const CycleRow moved{clip, warp.frame_at(row.first), warp.frame_at(row.end),
                             label(row.label)};
        if (moved.first < moved.end) result.cycles.push_back(moved);
    }
    return result;
}

class VariedTakes : public TakeMaker {
  public:
    explicit VariedTakes(const GenerateOptions& options)
        : seed_(options.seed),
          sources_(find_takes(options.from)),
          annotations_(read_annotations(options.from)) {
        plan(options.frames);
    }

    int64_t takes() const override { return static_cast<int64_t>(plan_.size()); }
    int64_t subjects() const override { return plan_.back().subject; }

    NewTake make(int64_t index) const override {
        const PlannedTake& planned = plan_[static_cast<size_t>(index)];
        const SourceTake& source = sources_[planned.source];
        const Variation variation = random_variation(planned.subject, seed_);
        TimeWarp warp = warp_of(index, source);
        warp.cut(planned.frames);

        const Clip original = read_clip(source);
        if (original.frames() != source.frames)
            throw InputError::in_file(source.motion.string(), "changed while it was read");
        Clip clip = scaled(sample(original, warp.source_frames(), original.rate), variation.scale);
        if (variation.mirrored) clip = mirrored_take(clip, source.skeleton);

        NewTake take;
        take.subject = fmt::format("{:02}", planned.subject);
        take.name = fmt::format("{:02}_{:02}", planned.subject, planned.number);
        take.first_of_subject = planned.number == 1;
        take.clip = std::move(clip);
        const auto rows = annotations_.find(source.motion.stem().string());
        if (rows != annotations_.end())
            take.annotations = carried_over(rows->second, take.name, warp, variation.mirrored);
        return take;
    }

  private:
    TimeWarp warp_of(int64_t index, const SourceTake& source) const {
        RandomStream random(seed_, "time warp", static_cast<uint64_t>(index));
        return {source.frames, random};
    }

    /// Goes through the source again and again; each round makes new subjects.
    void plan(int64_t frames) {
        constexpr int64_t shortest_rest = 120;  // the last take should have a second to show
        int64_t subject = 0, number = 0;
        for (size_t i = 0; frames > 0; i = (i + 1) % sources_.size()) {
            const bool same = i > 0 && sources_[i].skeleton == sources_[i - 1].skeleton;
            if (!same) ++subject;
            number = same ? number + 1 : 1;
            int64_t length =
                std::min(frames, warp_of(static_cast<int64_t>(plan_.size()), sources_[i]).frames());
            const int64_t rest = frames - length;
            if (rest > 0 && rest < shortest_rest && length > 2 * shortest_rest)
                length -= shortest_rest - rest;
            plan_.push_back({i, subject, number, length});
            frames -= length;
        }
    }

    uint64_t seed_;
    std::vector<SourceTake> sources_;
    AnnotationsByClip annotations_;
    std::vector<PlannedTake> plan_;
};

}  // namespace

std::unique_ptr<TakeMaker> varied_takes(const GenerateOptions& options) {
    return std::make_unique<VariedTakes>(options);
}

}  // namespace kinetome
