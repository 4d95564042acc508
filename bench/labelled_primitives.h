// Primitives of takes and their annotated labels, as `kinetome reindex` and `label` see them.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "kinetome/base/parallel.h"
#include "kinetome/models/activity.h"
#include "kinetome/models/movement_rows.h"
#include "kinetome/models/primitive.h"
#include "kinetome/stages/stored_labels.h"
#include "kinetome/synthesis/corpus_generator.h"
#include "support/temporary_folder.h"
#include "takes.h"

namespace kinetome::bench {

inline constexpr double primitives_rate = 30;

/// Primitives of several takes, with the labels of an annotation.
struct Primitives {
    MatrixF poses;      ///< stacked effectors, take below take
    MatrixF movements;  ///< the same as movement_rows
    std::vector<CorpusPrimitive> all;
    std::vector<ClipPrimitive> of_clips;

    MatrixFView rows(const MatrixF& of, size_t primitive) const {
        const RowRange& range = all[primitive].rows;
        return of.middleRows(range.first, range.size());
    }
    std::set<int64_t> clips() const {
        std::set<int64_t> clips;
        for (const CorpusPrimitive& primitive : all) clips.insert(primitive.clip);
        return clips;
    }
};

struct NamedTake {
    std::string name;
    Clip clip;
};

/// As `kinetome reindex` finds them with its own defaults.
inline Primitives find_in(const std::vector<NamedTake>& takes, int threads) {
    struct Found {
        MatrixF poses;
        std::vector<Primitive> primitives;
    };
    std::vector<Found> found(takes.size());
    parallel_for(threads, static_cast<int64_t>(takes.size()), [&](int64_t i) {
        Found& own = found[size_t(i)];
        own.poses = stacked_effectors(takes[size_t(i)].clip, primitives_rate);
        const NeighborGraph graph = neighbor_graph(own.poses, KnnOptions{}, KnnEngine::blocks, 1);
        own.primitives =
            find_primitives(own.poses, graph, find_activities(graph, own.poses, {}), {});
    });
    Primitives result;
    int64_t frames = 0;
    for (const Found& own : found) frames += own.poses.rows();
    result.poses.resize(frames, found.front().poses.cols());
    int64_t row = 0;
    for (size_t t = 0; t < takes.size(); ++t) {
        const auto factor = std::llround(takes[t].clip.rate / primitives_rate);
        result.poses.middleRows(row, found[t].poses.rows()) = found[t].poses;
        for (const Primitive& primitive : found[t].primitives) {
            const RowRange& range = primitive.frames;
            result.all.push_back({int64_t(t), {row + range.first, row + range.end}});
            result.of_clips.push_back(
                {.clip = takes[t].name,
                 .first = range.first * factor,
                 .end = std::min<int64_t>(range.end * factor, takes[t].clip.frames())});
        }
        row += found[t].poses.rows();
    }
    result.movements = movement_rows(result.poses, result.all);
    return result;
}

/// Those with a label, and their labels as numbers.
struct Labelled {
    Primitives primitives;
    std::vector<std::string> names;
    std::vector<int32_t> labels;
};

inline Labelled with_labels(Primitives primitives, const std::vector<CycleRow>& rows) {
    label_primitives(primitives.of_clips, rows);
    const LabelNames names(primitives.of_clips);
    const std::vector<int32_t> numbers = names.numbers(primitives.of_clips);
    Labelled result;
    for (int32_t label = 0; label < names.count(); ++label) {
        result.names.push_back(names.name(label));
    }
    Primitives& kept = result.primitives;
    for (size_t p = 0; p < numbers.size(); ++p) {
        if (numbers[p] < 0) continue;
        kept.all.push_back(primitives.all[p]);
        kept.of_clips.push_back(std::move(primitives.of_clips[p]));
        result.labels.push_back(numbers[p]);
    }
    kept.poses = std::move(primitives.poses);
    kept.movements = std::move(primitives.movements);
    return result;
}

inline std::vector<NamedTake> read_all(const std::filesystem::path& folder, int threads) {
    std::vector<std::filesystem::path> files = amc_files(folder);
    std::ranges::sort(files);
    std::vector<NamedTake> takes(files.size());
    parallel_for(threads, int64_t(files.size()), [&](int64_t i) {
        takes[size_t(i)] = {files[size_t(i)].stem().string(), read_take(files[size_t(i)])};
    });
    return takes;
}

/// The primitives of a generated corpus, labelled by its cycles.
inline Labelled generated_primitives(const GenerateOptions& options, int threads) {
    const TemporaryFolder folder;
    const std::filesystem::path corpus = folder / "corpus", cycles = corpus / "cycles.csv";
    generate_corpus(options, corpus, threads);
    return with_labels(find_in(read_all(corpus, threads), threads),
                       parse_cycles_csv(read_source_file(cycles), cycles.string()));
}

}  // namespace kinetome::bench
