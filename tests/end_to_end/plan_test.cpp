// `plan`: what a run would take, told without doing any of it.
#include <sys/mount.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "store_on_disk.h"
#include "support/temporary_folder.h"
#include "takes.h"

namespace {

using Json = nlohmann::json;

std::vector<std::string> plan(const fs::path& corpus, const fs::path& store,
                              const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = reindex(corpus, store, more);
    words.front() = "plan";
    return words;
}

Json planned(const fs::path& corpus, const fs::path& store, std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--format", "json"});
    return Json::parse(require_program(plan(corpus, store, more)).output);
}

Json stage_of(const Json& estimate, const std::string& name) {
    for (const Json& stage : estimate.at("stages")) {
        if (stage.at("name") == name) return stage;
    }
    FAIL("no stage is called " << name);
    return {};
}

/// Names and times of all that is below a folder.
std::map<std::string, fs::file_time_type> all_below(const fs::path& folder) {
    std::map<std::string, fs::file_time_type> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const bool of_lease = contains(entry.path().string(), "/locks");
        if (!of_lease && !entry.is_symlink())
            found[entry.path().string()] = entry.last_write_time();
    }
    return found;
}

std::map<std::string, std::string> shell_values(const std::string& output) {
    static const std::regex safe("([a-z_]+)=([0-9]+|[0-9]{2,}:[0-5][0-9]:[0-5][0-9])");
    std::map<std::string, std::string> values;
    for (const std::string& line : lines_of(output)) {
        std::smatch match;
        INFO(line);
        REQUIRE(std::regex_match(line, match, safe));
        values[match[1].str()] = match[2].str();
    }
    return values;
}

}  // namespace

TEST_CASE("a plan for a store that is not there tells everything and makes nothing", "[plan]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes", store = folder / "not" / "yet";
    generate_corpus(corpus, 20'000, 2);
    const Json estimate = planned(corpus, store);
    CHECK_FALSE(fs::exists(folder / "not"));
    CHECK(estimate.at("frames") == 20'000);
    CHECK(estimate.at("left_out") == 0);
    CHECK(estimate.at("classes").size() == 1);
    CHECK(contains(estimate.at("rates").get<std::string>(), "shipped"));
    CHECK(estimate.at("free_bytes") > estimate.at("needed_bytes"));
    for (const Json& stage : estimate.at("stages")) {
        INFO(stage);
        for (const char* name : {"make", "frames", "seconds", "bytes", "peak_bytes"}) {
            CHECK(stage.at(name) > 0);
        }
        CHECK(stage.at("reuse") == 0);
    }
    const std::string text = require_program(plan(corpus, store)).output;
    for (const char* part :
         {"takes ", "class ", "pose_clusters ", "whole run", "disk ", "ranks "}) {
        CHECK(contains(text, part));
    }
}

TEST_CASE("what is up to date costs nothing, what is not costs as before", "[plan]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes", store = folder / "store";
    generate_corpus(corpus, 20'000, 2);
    require_program(reindex(corpus, store));
    const auto before = all_below(store);
    const Json done = planned(corpus, store);
    CHECK(done.at("seconds") == 0);
    CHECK(done.at("needed_bytes") == 0);
    CHECK(done.at("needed_inodes") == 0);
    CHECK(done.at("peak_bytes") == 0);
    CHECK(done.at("helpful_ranks") == 1);
    for (const Json& stage : done.at("stages")) CHECK(stage.at("make") == 0);
    CHECK(stage_of(done, "motion_strings").at("reuse") == 1);
    CHECK(contains(done.at("rates").get<std::string>(), "generation "));

    const Json strings = planned(corpus, store, {"--tau", "5"});
    CHECK(stage_of(strings, "motion_strings").at("make") == 1);
    CHECK(stage_of(strings, "pose_clusters").at("make") == 0);
    CHECK(strings.at("seconds") > 0);
    const Json clusters = planned(corpus, store, {"--clusters", "61"});
    CHECK(stage_of(clusters, "pose_clusters").at("make") == 1);
    CHECK(clusters.at("seconds") > strings.at("seconds"));
    CHECK(all_below(store) == before);
}

TEST_CASE("what a killed run has finished costs nothing", "[plan]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes", store = folder / "store";
    generate_corpus(corpus, 20'000, 2);
    require_program(
        {"ingest", corpus.string(), "--store", store.string(), "--shard-frames", "8192"});
    const Json estimate = planned(corpus, store);
    CHECK(stage_of(estimate, "frames").at("make") == 0);
    CHECK(stage_of(estimate, "frames").at("seconds") == 0);
    CHECK(stage_of(estimate, "features").at("make") > 0);
}

TEST_CASE("more frames, clusters and iterations cost more, more threads and ranks never do",
          "[plan]") {
    const TemporaryFolder folder;
    const fs::path small = folder / "small", large = folder / "large", store = folder / "store";
    generate_corpus(small, 10'000, 1);
    generate_corpus(large, 40'000, 1);
    const Json base = planned(small, store, {"--threads", "1"});
    const Json more = planned(large, store, {"--threads", "1"});
    for (const char* name : {"seconds", "needed_bytes"}) CHECK(more.at(name) > base.at(name));
    for (const Json& stage : base.at("stages")) {
        CHECK(stage_of(more, stage.at("name")).at("seconds") > stage.at("seconds"));
    }
    const auto seconds = [&](const std::vector<std::string>& options) {
        return planned(large, store, options).at("seconds").get<double>();
    };
    const double one = more.at("seconds");
    CHECK(seconds({"--threads", "1", "--clusters", "600"}) > one);
    CHECK(seconds({"--threads", "1", "--max-iterations", "100"}) > one);
    CHECK(seconds({"--threads", "1", "--restarts", "2"}) > one);
    CHECK(seconds({"--threads", "2"}) < one);
    CHECK(seconds({"--threads", "1", "--ranks", "2"}) <= one);
    const Json& table = more.at("by_ranks");
    CHECK(table.at(0).at("ranks") == 1);
    CHECK(table.at(0).at("seconds") == more.at("seconds"));
}

TEST_CASE("the plan for the shell is names and numbers that a script may evaluate", "[plan]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "it's $(touch x) takes", store = folder / "a `store`; exit";
    generate_corpus(corpus, 40'000, 2);
    const auto values = [&](const std::vector<std::string>& more) {
        std::vector<std::string> options = more;
        options.insert(options.end(), {"--format", "shell", "--threads", "3"});
        return shell_values(require_program(plan(corpus, store, options)).output);
    };
    const auto advised = values({});
    CHECK(advised.size() == 10);
    CHECK(advised.at("frames") == "40000");
    CHECK(advised.at("threads") == "3");
    CHECK(std::stoi(advised.at("memory_mb")) >= 512);
    CHECK(std::stoi(advised.at("ingest_memory_mb")) >= 512);
    CHECK(std::stoi(advised.at("ingest_tasks")) >= 1);
    CHECK(advised.at("time") >= "00:06:00");
    CHECK(advised.at("ingest_time") >= "00:06:00");
    const auto asked = values({"--ranks", "7"});
    CHECK(asked.at("ranks") == "7");
    CHECK(std::stoi(asked.at("ingest_tasks")) <= 7);

    require_program(reindex(corpus, store));
    const auto done = values({});
    CHECK(done.at("ingest_tasks") == "1");
    CHECK(done.at("ranks") == "1");
    CHECK(done.at("disk_mb") == "0");
}

TEST_CASE("a plan that opens the run leaves what the parts of the run join", "[plan]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 10'000, 1);
    const StoreOnDisk store(folder / "store"), alone(folder / "alone");
    require_program(plan(corpus, store.path(), {"--open"}));
    CHECK(fs::exists(store.run_folder() / "run.json"));
    CHECK_FALSE(store.current());
    require_program({"reindex", corpus.string(), "--store", store.name(), "--join"});
    require_program(reindex(corpus, alone.path()));
    CHECK(store.digests() == alone.digests());
}

TEST_CASE("a disk without room is refused by plan and reindex with the same numbers", "[plan]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes", disk = folder / "disk";
    generate_corpus(corpus, 20'000, 1);
    fs::create_directory(disk);
    const bool few_inodes = GENERATE(false, true);
    const char* const size = few_inodes ? "size=200m,nr_inodes=20" : "size=4m";
    if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, size) != 0) {
        WARN("SKIPPED: no right to mount a small disk");
        return;
    }
    const CommandResult told = run_program(plan(corpus, disk / "store"));
    const bool made_nothing = fs::is_empty(disk);
    const CommandResult refused = run_program(reindex(corpus, disk / "store"));
    const CommandResult opened = run_program(plan(corpus, disk / "store", {"--open"}));
    ::umount2(disk.c_str(), MNT_DETACH);

    CHECK(made_nothing);
    const std::string unit = few_inodes ? "inodes are free on its disk" : "are free on its disk";
    for (const CommandResult& result : {told, refused, opened}) {
        INFO(result.errors);
        CHECK(result.exit_code == 73);
        CHECK(contains(result.errors, "this run needs about"));
        CHECK(contains(result.errors, unit));
        CHECK_FALSE(contains(result.errors, "to be made"));
    }
    CHECK(contains(told.output, "whole run"));
}

TEST_CASE("rates come from the file that is given, and a bad one is refused", "[plan]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 10'000, 1);
    const fs::path rates = folder.write("slow.toml", R"(
machine = "slow"
[frames]
seconds_per_file = 1000
nanoseconds_per_value = 0
serial_share = 0
[features]
seconds_per_file = 0
nanoseconds_per_value = 0
serial_share = 0
[neighbors]
seconds_per_file = 0
nanoseconds_per_value = 0
serial_share = 0
[pose_hierarchy]
seconds_per_file = 0
nanoseconds_per_value = 0
serial_share = 0
[signatures]
seconds_per_file = 0
nanoseconds_per_value = 0
serial_share = 0
[corpus_neighbors]
seconds_per_file = 0
nanoseconds_per_value = 0
serial_share = 0
[search]
nanoseconds_per_row = 0
[bundles]
seconds_per_file = 0
nanoseconds_per_value = 0
serial_share = 0
[bundle_graph]
seconds_per_file = 0
nanoseconds_per_value = 0
serial_share = 0
[segments]
seconds_per_file = 0
nanoseconds_per_value = 0
serial_share = 0
[primitives]
seconds_per_file = 0
nanoseconds_per_value = 0
serial_share = 0
[poses]
seconds_per_file = 0
moments_nanoseconds_per_row = 0
projection_nanoseconds_per_row = 0
accessibility_nanoseconds_per_pair = 0
serial_share = 0
[[poses.mixture]]
clusters = 1
start_nanoseconds_per_row = 0
iteration_nanoseconds_per_row = 0
letter_nanoseconds_per_row = 0
)");
    const Json estimate =
        planned(corpus, folder / "store", {"--rates", rates.string(), "--shard-frames", "65536"});
    CHECK(estimate.at("rates") == rates.string());
    CHECK(stage_of(estimate, "frames").at("seconds") == 1000);
    CHECK(estimate.at("seconds") == 1000);

    write_text(rates, "[frames]\n");
    const CommandResult refused =
        run_program(plan(corpus, folder / "store", {"--rates", rates.string()}));
    CHECK(refused.exit_code == 64);
    CHECK(contains(refused.errors, "stage_rates_bench"));
}

TEST_CASE("a plan tells of takes that cannot be indexed, and refuses folders of another kind",
          "[plan]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 10'000, 1);
    fs::create_directory(corpus / "99");
    write_text(corpus / "99" / "99_01.amc", "1\nroot 0 0 0 0 0 0\n");
    CHECK(planned(corpus, folder / "store").at("left_out") == 1);

    CHECK(run_program(plan(folder / "nowhere", folder / "store")).exit_code == 65);
    const CommandResult other = run_program(plan(corpus, corpus));
    CHECK(other.exit_code == 73);
    CHECK(contains(other.errors, "is not a Kinetome store"));
    CHECK(run_program(plan(corpus, folder / "store", {"--only", "dances"})).exit_code == 64);
    CHECK(run_program(plan(corpus, folder / "store", {"--ranks", "0"})).exit_code == 64);
}
