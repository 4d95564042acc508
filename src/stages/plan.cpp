#include "kinetome/stages/plan.h"

#include <fmt/format.h>

#include <map>

#include "kinetome/base/file.h"
#include "kinetome/stages/pose_rows.h"
#include "kinetome/store/json_text.h"

namespace kinetome {
namespace {

/// Makes the keys of one plan. A result made of the whole corpus depends on its takes and options,
/// not on how the inputs were cut into files: its key is built on the *logical* keys of its inputs.
class KeyMaker {
  public:
    KeyMaker(const Survey& survey, const ReindexOptions& options)
        : survey_(survey), options_(options), rows_(option_rows(options_)) {}

    StageKey file_key(const StageRow& stage, const Shard* shard) {
        StageKey key = base_key(stage);
        for (const std::string& input : stage.inputs) {
            key.add("input " + input, shard ? shard_digest(stage_named(input), *shard)
                                            : logical_digest(stage_named(input)));
            if (stage.reads_all_shards) {
                key.add("all " + input, logical_digest(stage_named(input)));
            }
        }
        if (stage.inputs.empty()) key.add("takes", takes_digest(shard));
        add_options(key, "files", stage.sharded ? "" : "shard-frames");
        return key;
    }

  private:
    /// What the stage's result depends on beside its inputs.
    StageKey base_key(const StageRow& stage) {
        StageKey key;
        key.add("format", fmt::format("{}", stage.format_version));
        add_options(key, stage.name, "");
        if (stage.name == "frames" && !options_.frames.joint_map.empty()) {
            key.add("joint-map", digest_of(read_file(options_.frames.joint_map)));
        }
        if (stage.name == "pose_clusters") {
            key.add("subjects", subjects_digest(survey_, options_.partition));
            key.add("groups", groups_digest());
        }
        if (stage.name == "pose_hierarchy") key.add("groups", groups_digest());
        return key;
    }

    void add_options(StageKey& key, const std::string& stage, const std::string& left_out) {
        for (const OptionRow& row : rows_) {
            if (row.stage == stage && row.name != left_out)
                key.add("option " + row.name, row.get());
        }
    }

    Digest logical_digest(const StageRow& stage) {
        const auto known = logical_.find(stage.name);
        if (known != logical_.end()) return known->second;
        StageKey key = base_key(stage);
        for (const std::string& input : stage.inputs) {
            key.add("input " + input, logical_digest(stage_named(input)));
        }
        if (stage.inputs.empty()) key.add("takes", takes_digest(nullptr));
        return logical_[stage.name] = key.digest();
    }

    Digest shard_digest(const StageRow& stage, const Shard& shard) {
        return stage.sharded ? file_key(stage, &shard).digest() : logical_digest(stage);
    }

    /// Names and contents of the takes of a shard, or of all.
    Digest takes_digest(const Shard* shard) const {
        Hasher hasher;
        const auto add = [&](const Take& take) {
            if (take.quarantined.empty()) hasher.text(take.name).digest(take.content);
        };
        if (shard) {
            for (const size_t i : shard->clips) add(survey_.takes[i]);
        } else {
            for (const Take& take : survey_.takes) add(take);
        }
        return hasher.finish();
    }

    /// Where sums over the corpus are cut (base/pieces.h).
    Digest groups_digest() const {
        Hasher hasher;
        for (const ClipExtent& extent : survey_.extents()) {
            hasher.number(extent.name_hash).number(static_cast<uint64_t>(extent.claimed));
        }
        return hasher.finish();
    }

    const Survey& survey_;
    ReindexOptions options_;
    std::vector<OptionRow> rows_;
    std::map<std::string, Digest> logical_;
};

}  // namespace

RunPlan::RunPlan(Survey surveyed, const ReindexOptions& chosen)
    : survey(std::move(surveyed)),
      options(chosen),
      shards(plan_shards(survey.extents(), options.frames.shard_frames)) {
    KeyMaker keys(survey, options);
    for (const StageRow& stage : stage_table()) {
        if (!stage.is_wanted(options)) continue;
        if (!stage.sharded) {
            work.push_back(
                {&stage, nullptr, stage.file_name(nullptr), keys.file_key(stage, nullptr)});
            continue;
        }
        for (const Shard& shard : shards) {
            work.push_back({&stage, &shard, stage.file_name(&shard), keys.file_key(stage, &shard)});
        }
    }
}

std::vector<size_t> RunPlan::inputs_of(const PlannedWork& wanted) const {
    std::vector<size_t> inputs;
    for (const std::string& input : wanted.stage->inputs) {
        for (size_t i = 0; i < work.size(); ++i) {
            const bool is_read = !wanted.shard || !work[i].shard || work[i].shard == wanted.shard ||
                                 wanted.stage->reads_all_shards;
            if (work[i].stage->name == input && is_read) inputs.push_back(i);
        }
    }
    return inputs;
}

std::string write_run_record(const Survey& survey, const ReindexOptions& options) {
    Json takes = Json::array();
    for (const Take& take : survey.takes) {
        takes.push_back({{"name", take.name},
                         {"source", take.source},
                         {"skeleton_source", take.skeleton_source},
                         {"content", take.content.hex()},
                         {"claimed_frames", take.claimed_frames},
                         {"bytes", take.bytes},
                         {"quarantined", take.quarantined}});
    }
    return dump_json({{"corpus", survey.corpus.string()},
                      {"configuration", write_configuration(options)},
                      {"takes", takes}},
                     1) +
           "\n";
}

RunRecord parse_run_record(std::string_view json, const std::filesystem::path& path) {
    const auto record_from = [&](const Json& whole) {
        RunRecord record;
        record.survey.corpus = whole.at("corpus").get<std::string>();
        parse_configuration(whole.at("configuration").get<std::string>(), path.string(),
                            record.options);
        for (const Json& json_take : whole.at("takes")) {
            Take take;
            take.name = json_take.at("name");
            take.source = json_take.at("source");
            take.skeleton_source = json_take.at("skeleton_source");
            take.content = Digest::from_hex(json_take.at("content").get<std::string>());
            take.claimed_frames = json_take.at("claimed_frames");
            take.bytes = json_take.at("bytes");
            take.quarantined = json_take.at("quarantined");
            record.survey.takes.push_back(std::move(take));
        }
        return record;
    };
    return convert_json(parse_json(json, path, "a run record"), path, "a run record", record_from);
}

}  // namespace kinetome
