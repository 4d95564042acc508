// What `evaluate` promises: scores, pictures, and refusals that name file and line.
#include "program.h"
#include "support/temporary_folder.h"
#include "takes.h"

namespace {

const std::string truth_text =
    "clip,first,end,label,end_lo,end_hi\n"
    "../a,0,600,walk,540,660\n"
    "../a,600,1200,jump,1200,1200\n"
    "b,0,600,jump,600,600\n";

const std::string segments_text =
    "clip,first,end,kind,activity_cluster\n"
    "../a,0,560,activity,0\n"
    "../a,560,620,transition,\n"
    "../a,620,1200,activity,1\n"
    "b,0,600,activity,0\n"
    "not annotated,0,5,activity,0\n";

struct Tables {
    TemporaryFolder folder;
    std::string truth, segments;
    Tables()
        : truth(folder.write("truth.csv", truth_text).string()),
          segments(folder.write("segments.csv", segments_text).string()) {}
};

}  // namespace

TEST_CASE("segments of another program are scored and drawn", "[evaluate]") {
    const Tables tables;
    const fs::path pictures = tables.folder / "pictures";
    const CommandResult result =
        require_program({"evaluate", "--segments", tables.segments, "--truth", tables.truth,
                         "--svg", pictures.string(), "--format", "csv"});
    const auto lines = lines_of(result.output);
    REQUIRE(lines.size() == 1 + 2 + 1 + 2 + 5);
    CHECK(lines[1].starts_with("take,../a,0.95,1,1,1,1,"));
    CHECK(lines[2].starts_with("take,b,1,1,1,1,1,1,1,1,1,"));
    CHECK(lines[3].starts_with("mean,,"));
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(pictures)) {
        names.insert(entry.path().filename().string());
    }
    CHECK(names == std::set<std::string>{"___a.svg", "b.svg"});
    CHECK(contains(text_of(pictures / "b.svg"), ">annotation</text>"));

    const CommandResult text =
        require_program({"evaluate", "--segments", tables.segments, "--truth", tables.truth});
    CHECK(contains(text.output, "\nmean without b"));
}

TEST_CASE("what cannot be evaluated is refused, naming file and line", "[evaluate]") {
    const Tables tables;
    const auto refused = [&](const std::vector<std::string>& words, int exit_code,
                             const std::string& message) {
        std::vector<std::string> command = {"evaluate"};
        command.insert(command.end(), words.begin(), words.end());
        const CommandResult result = run_program(command);
        INFO(result.errors);
        CHECK(result.exit_code == exit_code);
        CHECK(contains(result.errors, message));
        CHECK(result.output.empty());
    };
    refused({"--segments", tables.segments, "--truth", tables.truth, "--clips", "a"}, 64,
            "--clips is of --what compression or estimation");
    refused({"--segments", tables.segments, "--truth", tables.truth, "--leaf-tolerance", "9"}, 64,
            "an option of the pose hierarchy is of --what");
    const std::string unknown =
        tables.folder.write("unknown.csv", "clip,first,end,label,end_lo,end_hi\nz,0,9,x,9,9\n");
    refused({"--segments", tables.segments, "--truth", unknown}, 65, "unknown.csv:2: clip 'z'");
    const std::string none =
        tables.folder.write("none.csv", "clip,first,end,label,end_lo,end_hi\n");
    refused({"--segments", tables.segments, "--truth", none}, 65, "none.csv: no clip");
    refused({"--segments", tables.truth, "--truth", tables.truth}, 65, "truth.csv:1: ");
    refused({"--truth", tables.truth}, 64, "--segments segments.csv");
    refused({"--truth", tables.truth, "--what", "primitives"}, 64, "--primitives");
    refused({"--truth", tables.truth, "--what", "all"}, 64, "--what all");
    refused({"--segments", tables.segments, "--truth", tables.truth, "--format", "xml"}, 64,
            "--format xml");
    refused({"--segments", tables.segments}, 64, "--truth");
}

TEST_CASE("primitives are counted against annotated cycles", "[evaluate]") {
    const Tables tables;
    const std::string primitives =
        tables.folder.write("primitives.csv",
                            "clip,first,end,activity_first,cluster,label\n"
                            "b,0,300,0,0,jump\nb,300,600,0,0,jump\n");
    const std::string cycles = tables.folder.write(
        "cycles.csv", "clip,first,end,label\nb,0,310,jump\nb,310,600,jump\n../a,0,500,walk\n");
    const CommandResult result =
        require_program({"evaluate", "--what", "primitives", "--primitives", primitives, "--truth",
                         tables.truth, "--cycles", cycles, "--format", "csv"});
    CHECK(contains(result.output, "\ntotal,,2,3,2,0.5,1,1\n"));
}

TEST_CASE("a store is evaluated as its exported tables are, peers and corpus beside",
          "[evaluate]") {
    const TemporaryFolder folder;
    const fs::path takes = folder / "takes", store = folder / "store";
    generate_corpus(takes, 6000, 1, 3);
    const std::string truth = (takes / "truth.csv").string();
    require_program(reindex(takes, store));
    const auto evaluate = [&](std::vector<std::string> words) {
        words.insert(words.begin(), "evaluate");
        words.insert(words.end(), {"--truth", truth, "--format", "csv"});
        return require_program(words).output;
    };
    const std::string segments = (folder / "segments.csv").string();
    const std::string primitives = (folder / "primitives.csv").string();
    require_program({"export", store.string(), "segments", "-o", segments});
    require_program({"export", store.string(), "primitives", "-o", primitives});
    const std::string of_store = evaluate({store.string()});
    CHECK(of_store == evaluate({"--segments", segments}));
    CHECK(of_store == evaluate({store.string(), "--segments", segments, "--rate", "50"}));
    CHECK(evaluate({store.string(), "--peer", "ppca"}).starts_with(of_store + "beside,PPCA,"));

    const std::string cycles = (takes / "cycles.csv").string();
    const std::string counted =
        evaluate({store.string(), "--what", "primitives", "--cycles", cycles});
    CHECK(counted ==
          evaluate({"--primitives", primitives, "--what", "primitives", "--cycles", cycles}));
    CHECK(contains(counted, "\ntotal,,"));
    CHECK(evaluate({store.string(), "--what", "variance"}).starts_with("class,cluster,"));

    const CommandResult recurrence =
        require_program({"evaluate", store.string(), "--what", "recurrence", "--format", "json"});
    CHECK(contains(recurrence.output, "takes"));

    const std::string timeline = require_program({"export", store.string(), "timeline"}).output;
    CHECK(timeline.starts_with("<svg "));
    CHECK(contains(timeline, ">01_01</text>"));
    CHECK(run_program({"export", store.string(), "timeline", "--format", "csv"}).exit_code == 64);

    const fs::path pictures = folder / "pictures";
    evaluate({store.string(), "--svg", pictures.string()});
    CHECK(contains(text_of(pictures / "01_01.svg"), "a primitive begins"));
}

TEST_CASE("a table that does not fit the store is refused", "[evaluate]") {
    const TemporaryFolder folder;
    const fs::path takes = folder / "takes", store = folder / "store";
    generate_corpus(takes, 1500, 1, 3);
    require_program(reindex(takes, store));
    const auto refused = [&](const std::string& rows, int exit_code, const std::string& message) {
        const fs::path table =
            folder.write("table.csv", "clip,first,end,kind,activity_cluster\n" + rows);
        const CommandResult result =
            run_program({"evaluate", store.string(), "--segments", table.string(), "--truth",
                         (takes / "truth.csv").string()});
        CHECK(result.exit_code == exit_code);
        CHECK(contains(result.errors, message));
    };
    refused("01_01,0,7,activity,0\n", 65, "table.csv: the segments of clip '01_01' end at frame 7");
    refused("99_99,0,7,activity,0\n", 64, "no clip '99_99' is indexed");
}
