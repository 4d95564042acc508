#include "kinetome/stages/graph_rows.h"

#include <algorithm>
#include <utility>

#include "kinetome/math/knn.h"
#include "kinetome/stages/graph_features.h"

namespace kinetome {
namespace {

int64_t rows_in(uint64_t bytes, uint64_t bytes_per_row) {
    constexpr uint64_t least = 1024, most = uint64_t{1} << 20;
    return static_cast<int64_t>(std::clamp(bytes / bytes_per_row, least, most));
}

}  // namespace

GraphRows::GraphRows(std::vector<GraphClip> clips, const ReindexOptions& options)
    : clips_(std::move(clips)), offsets_{0}, options_(options) {
    for (const GraphClip& clip : clips_) {
        offsets_.push_back(offsets_.back() + clip.place.effector_rows);
    }
}

size_t GraphRows::clip_of(int64_t row) const {
    const auto after = std::upper_bound(offsets_.begin(), offsets_.end(), row);
    return static_cast<size_t>(after - offsets_.begin()) - 1;
}

MatrixF GraphRows::features(const RowRange& range) const {
    const size_t end_clip = clip_of(range.end - 1) + 1;
    const auto columns = static_cast<Eigen::Index>(9 * options_.neighbors.joints.size());
    MatrixF rows(range.size(), columns);
    for (size_t c = clip_of(range.first); c < end_clip;) {
        size_t next = c + 1;  // clips of a shard are read at once: they share chunks of the file
        while (next < end_clip && clips_[next].shard == clips_[c].shard) ++next;
        const FeatureShardClip& first = clips_[c].place;
        const MatrixF effectors = clips_[c].shard->effectors(
            first.clip_class, first.first_effector_row, offsets_[next] - offsets_[c]);
        const int64_t row_of_effectors = offsets_[c];
        for (; c < next; ++c) {
            const MatrixF clip = graph_features(
                effectors.middleRows(offsets_[c] - row_of_effectors, offsets_[c + 1] - offsets_[c]),
                options_);
            const int64_t from = std::max(offsets_[c], range.first);
            const int64_t end = std::min(offsets_[c + 1], range.end);
            rows.middleRows(from - range.first, end - from) =
                clip.middleRows(from - offsets_[c], end - from);
        }
    }
    return rows;
}

std::map<std::string, GraphRows> graph_rows(const StageContext& context,
                                            const std::vector<const FinishedWork*>& features) {
    std::map<std::string, std::vector<GraphClip>> classes;
    for (const FinishedWork* work : features) {
        const auto shard =
            std::make_shared<const FeatureShardReader>(context.workspace.open(*work));
        for (const FeatureShardClip& place : shard->clips()) {
            if (place.effector_rows == 0) continue;
            classes[place.clip_class].push_back({place, shard, work->receipt.shard});
        }
    }
    std::map<std::string, GraphRows> rows;
    for (auto& [name, clips] : classes) {
        rows.emplace(name, GraphRows(std::move(clips), context.options));
    }
    return rows;
}

GraphSearchSize::GraphSearchSize(const ReindexOptions& options, const Resources& resources) {
    constexpr uint64_t copies_in_index = 3;  // the rows themselves, their boxes and projections
    const uint64_t features = 9 * options.neighbors.joints.size() * sizeof(float);
    const auto most = static_cast<uint64_t>(options.neighbors.knn.neighbours);
    bytes_per_query = features + 2 * most * sizeof(RowOfWhole);
    bytes_per_row = (1 + copies_in_index) * features;
    queries = rows_in(resources.memory_bytes / 8, bytes_per_query);
    rows = rows_in(resources.memory_bytes / 8, bytes_per_row);
}

}  // namespace kinetome
