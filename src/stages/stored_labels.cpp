#include "kinetome/stages/stored_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/models/movement_rows.h"
#include "kinetome/stages/graph_features.h"
#include "kinetome/stages/segment_file.h"
#include "kinetome/store/feature_store.h"

namespace kinetome {
namespace {

/// Where the effectors of clips are.
class EffectorShards {
  public:
    explicit EffectorShards(const Generation& generation) {
        for (const Receipt* receipt : generation.made_by("features")) {
            shards_.emplace_back(generation.open(receipt->file.file_name));
        }
        for (size_t s = 0; s < shards_.size(); ++s) {
            for (size_t i = 0; i < shards_[s].clips().size(); ++i) {
                places_[shards_[s].clips()[i].name] = {s, i};
            }
        }
    }
    MatrixF read(const std::string& clip) const {
        const auto& [shard, number] = places_.at(clip);
        const FeatureShardClip& place = shards_[shard].clips()[number];
        return shards_[shard].effectors(place.clip_class, place.first_effector_row,
                                        place.effector_rows);
    }

  private:
    std::vector<FeatureShardReader> shards_;
    std::map<std::string, std::pair<size_t, size_t>> places_;
};

void append_counts(Table& table, const std::string& knowledge, const std::string& label,
                   const LabelCounts& counts) {
    table.rows.push_back({knowledge, label, counts.examples, counts.found, counts.correct,
                          counts.missed, counts.precision(), counts.recall()});
}

Table empty_score() {
    return {{"knowledge", "label", "examples", "found", "correct", "missed", "precision", "recall"},
            {}};
}

void append_table(Table& table, const std::string& knowledge, const LabelNames& names,
                  const LabelTable& counts) {
    for (int32_t label = 0; label < names.count(); ++label) {
        append_counts(table, knowledge, names.name(label),
                      counts.labels[static_cast<size_t>(label)]);
    }
    append_counts(table, knowledge, "all", counts.all);
}

/// The primitives with the labels of the annotation alone.
std::vector<ClipPrimitive> annotated(std::vector<ClipPrimitive> primitives,
                                     const std::vector<CycleRow>& truth) {
    for (ClipPrimitive& primitive : primitives) primitive.label.clear();
    label_primitives(primitives, truth);
    return primitives;
}

/// The label of each primitive of `clip` by those of all other clips; -1 for the other ones.
std::vector<int32_t> labels_from_others(const PrimitiveFeatures& features, int64_t clip,
                                        const std::vector<int32_t>& true_labels,
                                        const LabelTransferOptions& options, int threads) {
    std::vector<int32_t> known = true_labels;
    std::vector<CorpusPrimitive> asked;
    std::vector<size_t> places;
    for (size_t p = 0; p < known.size(); ++p) {
        if (features.primitives[p].clip != clip) continue;
        known[p] = -1;
        asked.push_back(features.primitives[p]);
        places.push_back(p);
    }
    const KnowledgeBase base(features.features, features.primitives, known);
    const auto guesses = transfer_labels(base, features.features, asked, options, threads);
    std::vector<int32_t> given(known.size(), -1);
    for (size_t i = 0; i < places.size(); ++i) given[places[i]] = guesses[i].label;
    return given;
}

}  // namespace

PrimitiveFeatures read_primitive_features(const Generation& generation) {
    ReindexOptions options;
    const std::filesystem::path config = generation.folder() / "config.toml";
    parse_configuration(read_file(config), config.string(), options);
    const EffectorShards shards(generation);
    const std::vector<PrimitiveClip> clips = read_primitives(generation.open("primitives.h5"));
    int64_t frames = 0, row = 0;
    for (const PrimitiveClip& clip : clips) frames += clip.clip.frames;
    PrimitiveFeatures result;
    for (size_t c = 0; c < clips.size(); ++c) {
        std::vector<CorpusPrimitive> primitives;
        for (const StoredPrimitive& stored : clips[c].primitives) {
            primitives.push_back({static_cast<int64_t>(c), stored.primitive.frames});
        }
        const MatrixF rows =
            movement_rows(graph_features(shards.read(clips[c].clip.name), options), primitives);
        if (result.features.rows() == 0) result.features.resize(frames, rows.cols());
        result.features.middleRows(row, rows.rows()) = rows;
        for (const CorpusPrimitive& primitive : primitives) {
            const RowRange& range = primitive.rows;
            result.primitives.push_back({primitive.clip, {row + range.first, row + range.end}});
        }
        row += rows.rows();
    }
    return result;
}

LabelNames::LabelNames(std::span<const ClipPrimitive> primitives) {
    std::set<std::string> names;
    for (const ClipPrimitive& primitive : primitives) {
        if (!primitive.label.empty()) names.insert(primitive.label);
    }
    names_.assign(names.begin(), names.end());
}

std::vector<int32_t> LabelNames::numbers(std::span<const ClipPrimitive> primitives) const {
    std::vector<int32_t> numbers;
    for (const ClipPrimitive& primitive : primitives) {
        const auto at = std::lower_bound(names_.begin(), names_.end(), primitive.label);
        const bool is_known = at != names_.end() && *at == primitive.label;
        numbers.push_back(is_known ? static_cast<int32_t>(at - names_.begin()) : -1);
    }
    return numbers;
}

TransferredLabels transfer_labels(const PrimitiveFeatures& features,
                                  std::vector<ClipPrimitive> primitives,
                                  const LabelTransferOptions& options, int threads) {
    const LabelNames names(primitives);
    const std::vector<int32_t> known = names.numbers(primitives);
    std::vector<CorpusPrimitive> asked;
    for (size_t p = 0; p < known.size(); ++p) {
        if (known[p] < 0) asked.push_back(features.primitives[p]);
    }
    const KnowledgeBase base(features.features, features.primitives, known);
    const auto found = transfer_labels(base, features.features, asked, options, threads);

    TransferredLabels result;
    auto next = found.begin();
    for (size_t p = 0; p < known.size(); ++p) {
        result.is_known.push_back(known[p] >= 0);
        result.guesses.push_back(known[p] >= 0 ? LabelGuess{} : *next++);
        const int32_t label = result.guesses.back().label;
        if (label >= 0) primitives[p].label = names.name(label);
    }
    result.primitives = std::move(primitives);
    return result;
}

Table label_rows(const TransferredLabels& labels) {
    Table table{{"clip", "first", "end", "label", "origin", "cost", "source_clip", "source_first"},
                {}};
    for (size_t p = 0; p < labels.primitives.size(); ++p) {
        const ClipPrimitive& primitive = labels.primitives[p];
        const LabelGuess& guess = labels.guesses[p];
        const bool transferred = guess.label >= 0;
        std::vector<Table::Cell> row{primitive.clip, primitive.first, primitive.end,
                                     primitive.label};
        row.emplace_back(labels.is_known[p] ? "known" : transferred ? "transferred" : "none");
        if (transferred) {
            const ClipPrimitive& source = labels.primitives[static_cast<size_t>(guess.source)];
            row.insert(row.end(), {guess.cost, source.clip, source.first});
        } else {
            row.insert(row.end(), {"", "", ""});
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

Table label_score(const TransferredLabels& labels, const std::vector<CycleRow>& truth) {
    std::vector<ClipPrimitive> given = labels.primitives, right = annotated(given, truth);
    std::vector<ClipPrimitive> all = given;
    all.insert(all.end(), right.begin(), right.end());
    const LabelNames names(all);
    for (size_t p = 0; p < right.size(); ++p) {
        if (labels.is_known[p]) right[p].label.clear();  // nothing was asked of them
    }
    Table table = empty_score();
    append_table(table, "labels", names,
                 label_table(names.numbers(right), names.numbers(given), names.count()));
    return table;
}

Table label_tables(const PrimitiveFeatures& features, const std::vector<ClipPrimitive>& primitives,
                   const std::vector<CycleRow>& truth, const std::vector<std::string>& known_takes,
                   const LabelTransferOptions& options, int threads) {
    const std::vector<ClipPrimitive> right = annotated(primitives, truth);
    const LabelNames names(right);
    const std::vector<int32_t> true_labels = names.numbers(right);
    std::map<std::string, int64_t> clips;  // annotated ones → their numbers
    for (size_t p = 0; p < right.size(); ++p) {
        if (true_labels[p] >= 0) clips[right[p].clip] = features.primitives[p].clip;
    }
    std::vector<int32_t> given(true_labels.size(), -1);
    for (const auto& [name, clip] : clips) {
        const auto found = labels_from_others(features, clip, true_labels, options, threads);
        for (size_t p = 0; p < found.size(); ++p) given[p] = std::max(given[p], found[p]);
    }
    Table table = empty_score();
    append_table(table, "all other takes", names, label_table(true_labels, given, names.count()));

    std::vector<int64_t> known_clips;
    for (const std::string& name : known_takes) {
        const auto clip = clips.find(name);
        if (clip == clips.end()) {
            throw UsageError(
                fmt::format("--known-takes {}: no primitive of that take is annotated", name));
        }
        known_clips.push_back(clip->second);
    }
    const auto growing = label_tables(features.features, features.primitives, true_labels,
                                      names.count(), known_clips, options, threads);
    std::string knowledge;
    for (size_t k = 0; k < growing.size(); ++k) {
        knowledge += (k ? " " : "") + known_takes[k];
        append_table(table, knowledge, names, growing[k]);
    }
    return table;
}

}  // namespace kinetome
