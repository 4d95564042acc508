#include "kinetome/models/label_table.h"

#include <algorithm>
#include <stdexcept>

namespace kinetome {
namespace {

void check(std::span<const int32_t> labels, int32_t label_count) {
    for (const int32_t label : labels) {
        if (label < -1 || label >= label_count) {
            throw std::invalid_argument("a label is out of range");
        }
    }
}

double share(int64_t part, int64_t whole) {
    return whole == 0 ? 1 : double(part) / double(whole);
}

}  // namespace

double LabelCounts::precision() const {
    return share(correct, found);
}

double LabelCounts::recall() const {
    return share(correct, correct + missed);
}

LabelTable label_table(std::span<const int32_t> true_labels, std::span<const int32_t> given_labels,
                       int32_t label_count) {
    if (true_labels.size() != given_labels.size()) {
        throw std::invalid_argument("true and given labels are not of the same primitives");
    }
    check(true_labels, label_count);
    check(given_labels, label_count);
    LabelTable table;
    table.labels.resize(static_cast<size_t>(label_count));
    for (size_t i = 0; i < true_labels.size(); ++i) {
        const int32_t truth = true_labels[i], given = given_labels[i];
        if (truth < 0) continue;
        LabelCounts& own = table.labels[static_cast<size_t>(truth)];
        ++(truth == given ? own.correct : own.missed);
        ++(truth == given ? table.all.correct : table.all.missed);
        if (given < 0) continue;
        ++table.labels[static_cast<size_t>(given)].found;
        ++table.all.found;
    }
    return table;
}

std::vector<LabelTable> label_tables(const MatrixFView& features,
                                     std::span<const CorpusPrimitive> primitives,
                                     std::span<const int32_t> true_labels, int32_t label_count,
                                     std::span<const int64_t> known_clips,
                                     const LabelTransferOptions& options, int threads) {
    if (primitives.size() != true_labels.size()) {
        throw std::invalid_argument("each primitive must have one true label, or -1");
    }
    check(true_labels, label_count);
    std::vector<CorpusPrimitive> asked;
    std::vector<int32_t> truth;
    for (size_t i = 0; i < primitives.size(); ++i) {
        if (std::ranges::count(known_clips, primitives[i].clip) > 0) continue;
        asked.push_back(primitives[i]);
        truth.push_back(true_labels[i]);
    }
    std::vector<LabelTable> tables;
    std::vector<int32_t> known(true_labels.size(), -1);
    for (const int64_t clip : known_clips) {
        for (size_t i = 0; i < known.size(); ++i) {
            if (primitives[i].clip == clip) known[i] = true_labels[i];
        }
        const KnowledgeBase base(features, primitives, known);
        std::vector<int32_t> given;
        for (const LabelGuess& guess : transfer_labels(base, features, asked, options, threads)) {
            given.push_back(guess.label);
        }
        LabelTable table = label_table(truth, given, label_count);
        for (const int32_t label : known) {
            if (label < 0) continue;
            ++table.labels[static_cast<size_t>(label)].examples;
            ++table.all.examples;
        }
        tables.push_back(std::move(table));
    }
    return tables;
}

}  // namespace kinetome
