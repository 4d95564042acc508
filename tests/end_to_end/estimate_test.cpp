// What `estimate` and the evaluation of pose hierarchies promise.
#include "program.h"
#include "store_on_disk.h"
#include "support/temporary_folder.h"
#include "takes.h"

namespace {

constexpr int usage = 64, cannot_create = 73;

/// A store of generated takes and their pose hierarchy.
struct ModelledStore {
    TemporaryFolder folder;
    std::string path = (folder / "store").string();
    ModelledStore() {
        generate_corpus(folder / "takes", 6000, 2);
        require_program(
            reindex(folder / "takes", path, {"--only", "frames,features,pose_hierarchy"}));
    }
    std::string output(const std::string& name) const { return (folder / name).string(); }
};

}  // namespace

TEST_CASE("estimate writes motion and meter, and ends with the error", "[estimate]") {
    const ModelledStore store;
    const std::string take = (store.folder / "takes" / "01" / "01_01.amc").string();
    const CommandResult result =
        require_program({"estimate", store.path, "--file", take, "-o", store.output("e.bvh"),
                         "--meter", store.output("meter.csv")});
    const auto lines = lines_of(result.output);
    REQUIRE(lines.size() == 3);
    CHECK(lines[0].starts_with("principal     "));
    CHECK(lines[2].starts_with("rms_mm "));
    CHECK(std::stod(lines[2].substr(7)) > 0);
    const auto meter = lines_of(text_of(store.output("meter.csv")));
    CHECK(meter.at(0) == "frame,error_mm,leaf,leaf_changes");
    const std::string frames = std::to_string(meter.size() - 1);
    CHECK(contains(lines[1], frames + " frames at 120 a second"));
    CHECK(contains(text_of(store.output("e.bvh")), "Frames: " + frames + "\n"));

    // The same numbers taken for a slower take: the motion has its frames, not those in between.
    require_program({"estimate", store.path, "--file", take, "--amc-rate", "60", "-o",
                     store.output("slow.bvh")});
    CHECK(contains(text_of(store.output("slow.bvh")), "Frames: " + frames + "\n"));

    const CommandResult nowhere =
        run_program({"estimate", store.path, "--file", take, "-o", store.output("left.bvh"),
                     "--meter", store.output("no/meter.csv")});
    CHECK(nowhere.exit_code == cannot_create);
    CHECK_FALSE(fs::exists(store.output("left.bvh")));

    require_program({"estimate", store.path, "--file", take, "-o", "e.txt"}, usage);
    require_program({"estimate", store.path, "--file", store.output("e.txt")}, usage);
    require_program({"estimate", store.path}, usage);
}

TEST_CASE("a pose hierarchy is exported and evaluated", "[estimate]") {
    const ModelledStore store;
    const auto nodes = lines_of(require_program({"export", store.path, "hierarchy"}).output);
    CHECK(nodes.at(0) == "class,node,parent,below,above,leaf,frames,error_mm");
    CHECK(nodes.size() > 2);
    const auto evaluated = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"evaluate", store.path, "--format", "csv"});
        return lines_of(require_program(more).output);
    };
    const auto compression =
        evaluated({"--what", "compression", "--clips", "01_*", "--leaf-tolerance", "30"});
    CHECK(compression.at(0) ==
          "class,frames,principal,leaves,ratio,ratio_paper,rms_mm,p95_mm,max_mm");
    CHECK(compression.size() == 2);
    CHECK(evaluated({"--what", "estimation", "--held-out", "blocks"}).size() == 7);
    require_program({"evaluate", store.path, "--what", "compression", "--clips", "none"}, usage);
    require_program({"evaluate", store.path, "--what", "estimation", "--leaf-tolerance", "0"},
                    usage);
}

TEST_CASE("the paper's preset makes the paper's hierarchy", "[estimate]") {
    const ModelledStore store;
    const std::string path = store.output("paper");
    require_program(reindex(store.folder / "takes", path,
                            {"--only", "frames,features,pose_hierarchy", "--preset", "paper"}));
    const auto cells = [&](std::vector<std::string> command) {
        std::vector<std::vector<std::string>> rows;
        for (const auto& record : kinetome::parse_csv(require_program(command).output, "table")) {
            rows.push_back(record.fields);
        }
        return rows;
    };
    // Poses near planes help to make both children.
    int64_t copied = 0;
    const auto nodes = cells({"export", path, "hierarchy"});
    for (size_t i = 1; i < nodes.size(); ++i) {
        if (nodes[i].at(5) != "-1") copied += std::stoll(nodes[i].at(6));
    }
    CHECK(copied > 6000);
    // No pose is beyond the tolerance.
    const auto compression =
        cells({"evaluate", path, "--what", "compression", "--preset", "paper", "--format", "csv"});
    REQUIRE(compression.size() == 2);
    CHECK(std::stod(compression[1].at(8)) <= 20);
    // Maps follow the poses they were made of as nearly as linear maps can.
    const auto estimated = [&](const std::string& from) {
        const std::string take = (store.folder / "takes" / "01" / "01_01.amc").string();
        const auto lines = lines_of(
            require_program({"estimate", from, "--file", take, "--blend-band", "0"}).output);
        return std::stod(lines.back().substr(std::string("rms_mm ").size()));
    };
    CHECK(estimated(path) < estimated(store.path) / 2);
}
