#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>

#include "kinetome/base/file.h"
#include "kinetome/formats/write_amc.h"
#include "kinetome/stages/export.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/reindex.h"
#include "kinetome/stages/segment_file.h"
#include "kinetome/synthesis/corpus_generator.h"
#include "kinetome/synthesis/take.h"
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

double sway(double amplitude, double period, double seconds) {
    return amplitude * std::sin(2 * std::numbers::pi * seconds / period);
}

/// Someone who walks on for 15 seconds and cleans: beats with the forearms, from 5 s to 10 s sweeps
/// with the upper arms, and beats again.
Clip cleaning_walk(int64_t performer) {
    constexpr int64_t frames = 1800, stride = 130;
    SegmentPlan walking;
    walking.activity = Activity::walk;
    walking.end = walking.blend_first = walking.blend_end = frames;
    for (int64_t first = 0; first <= frames; first += stride)
        walking.cycles.push_back({double(first), double(stride), usual_traits()});
    TakePlan plan;
    plan.subject = performer;
    plan.number = 1;
    plan.frames = frames;
    plan.segments = {walking};

    constexpr uint64_t seed = 7;
    Clip take = perform(plan, make_subject(performer, seed), seed);
    const auto column = [&](const std::string& joint) {
        return take.skeleton->first_dof(take.skeleton->find(joint).value());
    };
    for (const std::string side : {"l", "r"}) {
        auto upper_arm = take.motion.middleCols<3>(column(side + "humerus"));
        upper_arm.rowwise() = upper_arm.colwise().mean().eval();
        auto elbow = take.motion.col(column(side + "radius"));
        for (int64_t frame = 0; frame < frames; ++frame) {
            const double seconds = double(frame) / synthesis_rate;
            const bool sweeps = frame >= frames / 3 && frame < frames * 2 / 3;
            elbow[frame] = static_cast<float>(1.4 + (sweeps ? 0 : sway(0.6, 0.8, seconds)));
            if (sweeps) upper_arm(frame, 1) += static_cast<float>(0.9 + sway(0.5, 1, seconds));
        }
    }
    return take;
}

/// The activities of each take, without the transitions between them.
std::map<std::string, std::vector<Segment>> activities_of_takes(const ReindexRequest& request) {
    reindex(request, Log(), {});
    std::map<std::string, std::vector<Segment>> activities;
    for (const auto& row : segment_table(OpenStore(request.store).generation).rows) {
        if (std::get<std::string>(row[3]) == "transition") continue;
        activities[std::get<std::string>(row[0])].push_back(
            {{std::get<int64_t>(row[1]), std::get<int64_t>(row[2])},
             SegmentKind::activity,
             static_cast<int32_t>(std::get<int64_t>(row[4]))});
    }
    return activities;
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

TEST_CASE("what arms do while legs walk on is told apart by the graph of the arms alone") {
    const TemporaryFolder folder;
    std::map<std::string, int64_t> frames;
    for (int64_t performer = 1; performer <= 4; ++performer) {
        const Clip take = cleaning_walk(performer);
        const std::string subject = "0" + std::to_string(performer), name = subject + "_01";
        const std::filesystem::path takes = folder / "takes" / subject;
        std::filesystem::create_directories(takes);
        write_file_atomically(takes / (subject + ".asf"), write_asf(*take.skeleton));
        write_file_atomically(takes / (name + ".amc"), write_amc(take));
        frames[name] = take.frames();
    }
    ReindexRequest request = request_for(folder / "takes", folder / "store");
    request.options.neighbors.adapt_radius = 0.75;
    const auto of_bodies = activities_of_takes(request);
    request.options.neighbors.joints = {JointRole::left_wrist, JointRole::right_wrist};
    const auto of_arms = activities_of_takes(request);
    for (const auto& [name, end] : frames) {
        CAPTURE(name);
        const std::vector<Segment>& body = of_bodies.at(name);
        REQUIRE(body.size() == 1);
        CHECK(body[0].frames.size() == end);

        const std::vector<Segment>& arms = of_arms.at(name);
        REQUIRE(arms.size() == 3);
        for (int64_t third = 1; third < 3; ++third) {
            const auto after = static_cast<size_t>(third);
            const int64_t found = (arms[after - 1].frames.end + arms[after].frames.first) / 2;
            CHECK(std::abs(found - third * end / 3) <= 40);  // a third of a second
        }
        CHECK(arms[0].cluster == arms[2].cluster);
        CHECK(arms[0].cluster != arms[1].cluster);
    }
}
