#include "kinetome/stages/options.h"

#include <catch2/catch.hpp>
#include <set>

#include "kinetome/base/error.h"

using namespace kinetome;

namespace {

std::vector<std::string> values_of(ReindexOptions options) {
    std::vector<std::string> values;
    for (const OptionRow& row : option_rows(options)) values.push_back(row.get());
    return values;
}

ReindexOptions parsed(const std::string& toml) {
    ReindexOptions options;
    parse_configuration(toml, "file.toml", options);
    return options;
}

}  // namespace

TEST_CASE("what is written as configuration reads back as the same options") {
    ReindexOptions options;
    options.frames.amc.rate = 59.94;
    options.frames.joint_map = "a \"quoted\"\npath";
    options.partition.rule = PartitionRule::subject;
    options.partition.subject_from = "(\\d+)/";
    options.pose_clusters.bic_clusters = {100, 200};
    options.pose_clusters.mixture.min_gain = 1e-7;
    options.pose_clusters.mixture.seed = 9223372036854775807U;
    CHECK(values_of(parsed(write_configuration(options))) == values_of(options));
}

TEST_CASE("joints are read in any words and written in the fewest") {
    const auto rewritten = [](const std::string& joints) {
        return write_configuration(parsed("joints = '" + joints + "'"));
    };
    const auto contains = [](const std::string& joints) {
        return Catch::Contains("joints = '" + joints + "'\n");
    };
    CHECK_THAT(write_configuration({}), contains("all"));
    CHECK_THAT(rewritten("left-arm,right-arm"), contains("arms"));
    CHECK_THAT(rewritten("right-leg,head,right-leg"), contains("head,right-leg"));
    CHECK_THAT(rewritten("legs,arms,head"), contains("all"));
    CHECK(parsed("joints = 'right-leg,head'").neighbors.joints ==
          std::vector{JointRole::head, JointRole::right_ankle});
}

TEST_CASE("every option has a name of its own") {
    ReindexOptions options;
    std::set<std::string> names;
    for (const OptionRow& row : option_rows(options)) CHECK(names.insert(row.name).second);
    CHECK(names.size() > 20);
}

TEST_CASE("a configuration that is wrong is refused, naming file and line") {
    CHECK_THROWS_WITH(parsed("seed = 1\nsede = 2\n"), Catch::Contains("file.toml:2"));
    CHECK_THROWS_WITH(parsed("\n\nseed = 'x'\n"), Catch::Contains("file.toml:3"));
    CHECK_THROWS_WITH(parsed("seed = \n"), Catch::Contains("file.toml:1"));
    CHECK_THROWS_AS(parsed("partition = 'sometimes'"), UsageError);
    CHECK_THROWS_AS(parsed("[table]\nseed = 1"), UsageError);
}

TEST_CASE("values that make no sense are refused before a run begins") {
    const auto refused = [](const std::string& toml) {
        CAPTURE(toml);
        CHECK_THROWS_AS(check_options(parsed(toml)), UsageError);
    };
    for (const char* toml : {"shard-frames = 8191",
                             "pose-rate = 0",
                             "variance-share = 1.5",
                             "least-clusters = 9000",
                             "cluster-rule = 'bic'",
                             "compression = 'zip'",
                             "subject-from = '('",
                             "subject-from = 'no group'",
                             "min-gain = -1",
                             "joint-map = '/no/such/file'",
                             "radius = 0",
                             "neighbours = 0",
                             "stack-offset = -0.1",
                             "knn-engine = 'ann'",
                             "adapt-radius = -1",
                             "joints = 'tail'",
                             "joints = ''",
                             "corpus-graph = 'maybe'",
                             "corpus-exclusion = -1",
                             "join-alternations = 'sometimes'",
                             "principal-tolerance = 0",
                             "principal-starts = 0",
                             "leaf-dimension = 0",
                             "leaf-tolerance = 0",
                             "leaf-rule = 'mean'",
                             "leaf-overlap = -1",
                             "marker-maps = 'ridge'",
                             "parent-weight = -1"}) {
        refused(toml);
    }
    CHECK_THROWS_AS(parsed("pose-rate = inf"), UsageError);
    CHECK_NOTHROW(check_options(ReindexOptions()));
    CHECK_NOTHROW(check_options(paper_options()));
}
