#include "kinetome/stages/take_estimate.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/stages/hierarchy_evaluation.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/reindex.h"
#include "kinetome/stages/take_file.h"
#include "kinetome/synthesis/corpus_generator.h"
#include "support/temporary_folder.h"

using namespace kinetome;
namespace fs = std::filesystem;

namespace {

/// A generated corpus and the store of it.
class SmallStore {
  public:
    SmallStore() {
        generate_corpus({.frames = 6000, .subjects = 2}, folder_ / "takes", 2);
        ReindexRequest request;
        request.corpus = folder_ / "takes";
        request.store = folder_ / "store";
        request.resources.threads = 2;
        request.resources.memory_bytes = uint64_t{1} << 30;
        request.only = {"frames", "features", "pose_hierarchy"};
        reindex(request, Log(), StopToken());
    }

    OpenStore open() const { return OpenStore(folder_ / "store"); }
    fs::path folder() const { return folder_.path(); }
    /// Some AMC take of the corpus.
    fs::path take() const {
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / "takes")) {
            if (entry.path().extension() == ".amc") return entry.path();
        }
        throw std::logic_error("no take was generated");
    }

  private:
    TemporaryFolder folder_;
};

double number(const Table::Cell& cell) {
    return std::holds_alternative<double>(cell) ? std::get<double>(cell)
                                                : static_cast<double>(std::get<int64_t>(cell));
}

}  // namespace

TEST_CASE("a take is estimated from its principal markers, and moves as they tell") {
    const SmallStore small;
    const OpenStore open = small.open();
    const Clip take = read_take_file(small.take());
    const ClassHierarchy model = model_for(open.generation, take);
    const TakeEstimate estimate = estimate_take(model, take);
    REQUIRE(estimate.errors.size() == static_cast<size_t>(take.frames()));
    CHECK(estimate.rms > 0);
    CHECK(estimate.rms < 30);
    for (const int32_t column : model.principal.columns) {
        CHECK(estimate.poses.col(column) == estimate.truth.col(column));
    }

    const Clip motion = estimated_motion(estimate);
    const MatrixF off = joint_positions(motion) - joint_positions(take);
    const auto values = static_cast<double>(off.rows() * take.skeleton->joint_count());
    CHECK(std::sqrt(off.cast<double>().squaredNorm() / values) < 6);  // cm

    const Table meter = meter_table(estimate);
    REQUIRE(meter.rows.size() == estimate.errors.size());
    double squared = 0;
    for (const auto& row : meter.rows) squared += std::pow(number(row[1]), 2);
    CHECK(std::sqrt(squared / double(meter.rows.size())) == Approx(estimate.rms));
    CHECK(number(meter.rows[0][3]) == 0);
}

TEST_CASE("a take of another class of skeletons is refused, and so is what is no take") {
    const SmallStore small;
    const OpenStore open = small.open();
    Clip other;
    other.skeleton = std::make_shared<const Skeleton>(
        "other", std::vector<Joint>{{.name = "root", .channels = {Channel::tx}}});
    CHECK_THROWS_WITH(model_for(open.generation, other), Catch::Contains("class"));
    CHECK_THROWS_AS(model_for(open.generation, other), UsageError);
    CHECK_THROWS_AS(read_take_file(small.folder() / "take.txt"), UsageError);
    const fs::path orphan = small.folder() / "orphan.amc";
    fs::copy_file(small.take(), orphan);
    CHECK_THROWS_WITH(read_take_file(orphan), Catch::Contains("no skeleton"));
}

TEST_CASE("takes of a store are chosen by name and evaluated") {
    const SmallStore small;
    const OpenStore open = small.open();
    const auto all = stored_markers(open.generation, "");
    const auto first = stored_markers(open.generation, "01_*");
    REQUIRE(all.size() == 1);
    REQUIRE(first.size() == 1);
    CHECK(first[0].names.size() < all[0].names.size());
    CHECK(first[0].poses == all[0].poses.topRows(first[0].poses.rows()));
    CHECK_THROWS_AS(stored_markers(open.generation, "99_*,nobody"), UsageError);

    HierarchyEvaluationOptions options;
    const Table by_rms = compression_table(all, options, Workers(2));
    options.hierarchy.leaf_rule = LeafRule::maximum;
    const Table by_maximum = compression_table(all, options, Workers(2));
    CHECK(number(by_rms.rows.at(0)[1]) == double(all[0].poses.rows()));
    CHECK(number(by_rms.rows.at(0)[4]) > number(by_maximum.rows.at(0)[4]));
    CHECK(number(by_maximum.rows.at(0)[8]) <= options.hierarchy.leaf_tolerance);
    CHECK(estimation_table(all, parse_held_out("blocks"), options, Workers(2)).rows.size() == 6);
    CHECK(estimation_table(all, parse_held_out("takes"), options, Workers(2)).rows.size() == 6);
    const auto one = stored_markers(open.generation, all[0].names[0]);
    CHECK_THROWS_AS(estimation_table(one, parse_held_out("takes"), options, Workers(2)),
                    UsageError);
    CHECK_THROWS_AS(parse_held_out("some"), UsageError);
}
