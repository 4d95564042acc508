#include <catch2/catch.hpp>
#include <map>

#include "kinetome/stages/export.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/reindex.h"
#include "kinetome/stages/segment_file.h"
#include "kinetome/synthesis/corpus_generator.h"
#include "support/temporary_folder.h"

using namespace kinetome;

namespace {

ReindexRequest request_for(const std::filesystem::path& corpus,
                           const std::filesystem::path& store) {
    ReindexRequest request;
    request.corpus = corpus;
    request.store = store;
    request.resources.threads = 2;
    request.resources.memory_bytes = uint64_t{1} << 30;
    request.options.pose_clusters.clusters = 4;
    request.options.pose_clusters.mixture.max_iterations = 1;
    return request;
}

/// Frames of a table's rows, by clip, in the order of the rows.
std::map<std::string, std::vector<std::pair<int64_t, int64_t>>> ranges_of(const Table& table) {
    std::map<std::string, std::vector<std::pair<int64_t, int64_t>>> ranges;
    for (const auto& row : table.rows) {
        ranges[std::get<std::string>(row[0])].emplace_back(std::get<int64_t>(row[1]),
                                                           std::get<int64_t>(row[2]));
    }
    return ranges;
}

}  // namespace

TEST_CASE("segments cover every frame of every take, primitives those of an activity") {
    const TemporaryFolder folder;
    generate_corpus({.frames = 6000, .subjects = 2}, folder / "takes", 2);
    reindex(request_for(folder / "takes", folder / "store"), Log(), {});
    const OpenStore store(folder / "store");
    const Generation& generation = store.generation;

    const auto segments = ranges_of(segment_table(generation));
    for (const CatalogClip& clip : generation.catalog().clips) {
        int64_t next = 0;
        for (const auto& [first, end] : segments.at(clip.name)) {
            CHECK(first == next);
            CHECK(end > first);
            next = end;
        }
        CHECK(next == clip.frames);
    }
    const Table primitives = primitive_table(store);
    REQUIRE(primitives.rows.size() > generation.catalog().clips.size());
    std::map<std::pair<std::string, int64_t>, int64_t> ends;  // (clip, activity) → covered so far
    for (const auto& row : primitives.rows) {
        const auto& clip = std::get<std::string>(row[0]);
        const auto activity = std::get<int64_t>(row[3]);
        const auto [covered, is_first] = ends.try_emplace({clip, activity}, activity);
        CHECK(std::get<int64_t>(row[1]) == covered->second);
        covered->second = std::get<int64_t>(row[2]);
    }
    std::map<std::string, int64_t> frames;
    for (const CatalogClip& clip : generation.catalog().clips) frames[clip.name] = clip.frames;
    for (const auto& row : segment_table(generation).rows) {
        if (std::get<std::string>(row[3]) == "transition") continue;
        const auto covered = ends.find({std::get<std::string>(row[0]), std::get<int64_t>(row[1])});
        REQUIRE(covered != ends.end());
        // The end of a take may cut a movement off.
        const int64_t end = std::get<int64_t>(row[2]);
        const bool ends_take = end == frames.at(std::get<std::string>(row[0]));
        CHECK((ends_take ? covered->second <= end : covered->second == end));
    }
}

TEST_CASE("every way to segment works on a graph of any radius") {
    const TemporaryFolder folder;
    generate_corpus({.frames = 2400, .subjects = 1}, folder / "takes", 2);
    for (const double radius : {5.0, 40.0, 200.0}) {
        for (const auto method : {ActivityMethod::repetition, ActivityMethod::region_growing}) {
            for (const auto primitives :
                 {PrimitiveMethod::cost_ridges, PrimitiveMethod::warping_paths}) {
                ReindexRequest request = request_for(folder / "takes", folder / "store");
                request.options.neighbors.knn.radius = radius;
                request.options.activities.method = method;
                request.options.primitives.method = primitives;
                CHECK_NOTHROW(reindex(request, Log(), {}));
            }
        }
    }
}
