// corpus_neighbors: the neighbours of each frame among the frames of all takes, shard by shard
// (S3 §3). The corpus is searched part by part, so that it need not fit into memory.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "kinetome/base/progress.h"
#include "kinetome/math/knn.h"
#include "kinetome/stages/graph_rows.h"
#include "kinetome/stages/stage.h"
#include "kinetome/store/catalog.h"
#include "kinetome/store/neighbor_store.h"

namespace kinetome {
namespace {

/// Parts of the whole, the ones that overlap `near` first: where frames have their nearest
/// neighbours, so that other parts have little left to offer.
std::vector<RowRange> parts_of(int64_t rows, int64_t size, const RowRange& near) {
    std::vector<RowRange> parts;
    for (int64_t first = 0; first < rows; first += size) {
        parts.push_back({first, std::min(first + size, rows)});
    }
    std::stable_partition(parts.begin(), parts.end(), [&](const RowRange& part) {
        return part.first < near.end && near.first < part.end;
    });
    return parts;
}

/// Rows of one take that are too near in time, numbered from the first of a part; none for 0
/// frames.
std::vector<RowRange> excluded_rows(const GraphRows& rows, const RowRange& queries, int64_t frames,
                                    int64_t first_of_part) {
    if (frames == 0) return {};
    std::vector<RowRange> excluded = rows_nearby_in_time(rows.offsets(), queries, frames);
    for (RowRange& range : excluded) {
        range = {range.first - first_of_part, range.end - first_of_part};
    }
    return excluded;
}

/// cm, by clip, of the graphs of the takes of a shard.
using Radii = std::map<std::string, double>;

Radii radii_of_shard(const StageContext& context, const StageTask& task) {
    Radii radii;
    for (const FinishedWork* work : task.inputs_of("neighbors")) {
        if (work->receipt.shard != task.shard->cut) continue;
        const NeighborShardReader graphs(context.workspace.open(*work));
        for (const NeighborShardClip& one : graphs.clips()) radii[one.clip.name] = one.clip.radius;
    }
    return radii;
}

/// Makes the graph of one shard.
class CorpusSearch {
  public:
    CorpusSearch(const StageContext& context, const GraphRows& rows, const Radii& radii)
        : context_(context), rows_(rows), radii_(radii), size_(context.options, context.resources) {
        for (const GraphClip& clip : rows.clips()) ids_.push_back(clip_id(clip.place.name));
    }

    /// Clips [first, end), a few at a time.
    void write(size_t first, size_t end, NeighborShardWriter& writer, Progress& progress) const {
        while (first < end) {
            size_t next = first + 1;  // one clip at least, however long
            while (next < end &&
                   rows_.offsets()[next + 1] - rows_.offsets()[first] <= size_.queries)
                ++next;
            const RowRange queries{rows_.offsets()[first], rows_.offsets()[next]};
            const ListsOfWhole found = search(queries);
            for (; first < next; ++first) write_clip(first, found, queries.first, writer);
            progress.advance(queries.size());
        }
    }

  private:
    ListsOfWhole search(const RowRange& range) const {
        const ReindexOptions& options = context_.options;
        const int64_t excluded_frames =
            std::llround(options.corpus_neighbors.exclusion * options.features.effector_rate);
        const int threads = context_.resources.threads;
        const MatrixF queries = rows_.features(range);
        ListsOfWhole found{options.neighbors.knn.neighbours, {}, {}};
        for (int64_t row = range.first; row < range.end; ++row) {
            found.radii.push_back(radii_.at(rows_.clips()[rows_.clip_of(row)].place.name));
        }
        found.lists.resize(found.radii.size());
        for (const RowRange& part : parts_of(rows_.rows(), size_.rows, range)) {
            context_.stop.check();
            context_.check_ranks();
            const KnnIndex index(rows_.features(part), KnnEngine::blocks, threads);
            index.search_more(queries, part.first, found, threads,
                              excluded_rows(rows_, range, excluded_frames, part.first));
        }
        return found;
    }

    void write_clip(size_t clip, const ListsOfWhole& found, int64_t first_query,
                    NeighborShardWriter& writer) const {
        StoredNeighbors graph;
        graph.offsets.push_back(0);
        for (int64_t row = rows_.offsets()[clip]; row < rows_.offsets()[clip + 1]; ++row) {
            append(found.lists[static_cast<size_t>(row - first_query)], graph);
        }
        const FeatureShardClip& place = rows_.clips()[clip].place;
        writer.add({place.name, place.clip_class, place.source_frames, place.source_rate,
                    radii_.at(place.name)},
                   graph.offsets, graph.neighbours, graph.distances, graph.clips);
    }

    void append(std::vector<RowOfWhole> list, StoredNeighbors& graph) const {
        std::ranges::sort(list, {}, &RowOfWhole::row);
        for (const RowOfWhole& one : list) {
            const size_t clip = rows_.clip_of(one.row);
            graph.clips.push_back(ids_[clip]);
            graph.neighbours.push_back(static_cast<int32_t>(one.row - rows_.offsets()[clip]));
            graph.distances.push_back(static_cast<float>(std::sqrt(one.squared)));
        }
        graph.offsets.push_back(static_cast<int64_t>(graph.neighbours.size()));
    }

    const StageContext& context_;
    const GraphRows& rows_;
    const Radii& radii_;
    const GraphSearchSize size_;
    std::vector<int64_t> ids_;
};

/// The clips of a shard: they follow each other.
std::pair<size_t, size_t> clips_of_shard(const GraphRows& rows, const std::string& cut) {
    const auto is_inside = [&](const GraphClip& clip) { return clip.cut == cut; };
    const auto first = std::ranges::find_if(rows.clips(), is_inside);
    const auto end = std::find_if_not(first, rows.clips().end(), is_inside);
    return {static_cast<size_t>(first - rows.clips().begin()),
            static_cast<size_t>(end - rows.clips().begin())};
}

}  // namespace

StageResult make_corpus_neighbors(const StageContext& context, const StageTask& task) {
    const auto classes = graph_rows(context, task.inputs_of("features"));
    const Radii radii = radii_of_shard(context, task);
    NeighborShardWriter writer(task.output, task.header, context.writing(),
                               context.options.features.effector_rate, NeighborScope::corpus);
    int64_t total = 0;
    for (const auto& [name, rows] : classes) {
        const auto [first, end] = clips_of_shard(rows, task.shard->cut);
        total += rows.offsets()[end] - rows.offsets()[first];
    }
    Progress progress(context.log, "corpus_neighbors " + task.shard->cut, total, "frames");
    for (const auto& [name, rows] : classes) {
        const auto [first, end] = clips_of_shard(rows, task.shard->cut);
        CorpusSearch(context, rows, radii).write(first, end, writer, progress);
    }
    StageResult result;
    result.file = writer.close();
    return result;
}

}  // namespace kinetome
