// What is asked of a store that lacks the stage for it, and of input that is missing or does not
// fit the store: the same answer whatever the command.
#include "program.h"
#include "support/temporary_folder.h"
#include "takes.h"

namespace {

constexpr int usage = 64, bad_input = 65;

struct Corpus {
    TemporaryFolder folder;
    std::string takes = (folder / "takes").string(), store = (folder / "store").string();
    std::string take = takes + "/01/01_01.amc", output = (folder / "out.bvh").string();

    explicit Corpus(const std::string& stages) {
        generate_corpus(takes, 4000, 1);
        require_program(reindex(takes, store, {"--only", stages}));
    }
    /// One command a line.
    void check(const std::vector<std::vector<std::string>>& commands, int expected,
               const std::string& message) const {
        for (const auto& words : commands) {
            const CommandResult result = run_program(words);
            INFO(words.front() << " " << words.back() << ": " << result.errors);
            CHECK(result.exit_code == expected);
            CHECK(contains(result.errors, message));
            CHECK(result.output.empty());
        }
    }
};

std::string labels(const std::string& rows) {
    return "clip,first,end,label\n" + rows;
}

}  // namespace

TEST_CASE("a stage that was left out is told alike by every command that needs it", "[input]") {
    const Corpus corpus("frames");
    const std::string &store = corpus.store, truth = corpus.takes + "/truth.csv";
    std::vector<std::vector<std::string>> commands = {
        {"bundles", store},
        {"walk", store, "-o", corpus.output},
        {"walk", store, "-o", corpus.output, "--graph", "bundles"},
        {"query", store, "--clip", "01_01"},
        {"query", store, "--file", corpus.take},
        {"query", store, "--bundle", "1"},
        {"estimate", store, "--file", corpus.take},
        {"compress", store, "-o", corpus.output},
        {"label", store, "--from", corpus.takes + "/cycles.csv"},
        {"label", store}};
    for (const std::string what :
         {"letters", "bundles", "bundle-graph", "hierarchy", "neighbors", "segments", "primitives",
          "primitive-graph", "signatures", "timeline"}) {
        commands.push_back({"export", store, what});
    }
    for (const std::string what : {"segments", "primitives", "bundles", "variance", "recurrence",
                                   "estimation", "compression"}) {
        commands.push_back({"evaluate", store, "--truth", truth, "--what", what});
    }
    corpus.check(commands, usage, "that stage was left out; `kinetome reindex " + corpus.takes);
    CHECK_FALSE(fs::exists(corpus.output));
}

TEST_CASE("input that is missing is told alike by every command that reads it", "[input]") {
    const Corpus corpus("frames,features,neighbors,segments,primitives");
    const std::string &store = corpus.store, none = (corpus.folder / "none.csv").string();
    corpus.check({{"estimate", store, "--file", none + ".amc"},
                  {"query", store, "--file", none + ".amc"},
                  {"decompress", none, "-o", corpus.output},
                  {"label", store, "--from", none},
                  {"export", store, "primitives", "--labels", none},
                  {"walk", store, "-o", corpus.output, "--labels", none},
                  {"evaluate", store, "--truth", none},
                  {"evaluate", "--truth", corpus.takes + "/truth.csv", "--segments", none}},
                 bad_input, "cannot be read: No such file");
}

TEST_CASE("labels that do not fit the store are refused, naming file and line", "[input]") {
    const Corpus corpus("frames,features,neighbors,segments,primitives");
    const std::string &store = corpus.store, table = (corpus.folder / "bad.csv").string();
    const std::string good = "01_01,0,100,walk\n";
    const auto refused = [&](const std::string& rows, const std::string& message) {
        corpus.folder.write("bad.csv", labels(rows));
        corpus.check({{"label", store, "--from", table},
                      {"export", store, "primitives", "--labels", table},
                      {"walk", store, "-o", corpus.output, "--labels", table}},
                     bad_input, table + ":" + message);
    };
    refused(good + "99_99,0,100,walk\n", "3: no clip '99_99' is indexed");
    refused(good + "01_01,100,99999,walk\n", "3: expected an end of at most ");
    refused(good + "01_01,200,300,walk\n01_01,90,120,jump\n",
            "4: frames 90 to 100 of clip '01_01' are 'jump' here and 'walk' in line 2");

    const std::string truth =
        corpus.folder.write("truth.csv", "clip,first,end,label,end_lo,end_hi\n99_99,0,9,x,9,9\n");
    corpus.check({{"evaluate", store, "--what", "bundles", "--truth", truth}}, bad_input,
                 "truth.csv:2: no clip '99_99' is indexed");

    // The store's own table outlives takes: those that are gone do not spoil it, wrong rows do.
    const auto own = [&](const std::string& rows, int expected) {
        write_text(fs::path(store) / "labels.csv", labels(rows));
        return require_program({"export", store, "primitives"}, expected).errors;
    };
    own(good + "01_01,100,200,walk\n01_01,150,250,walk\n99_99,0,100,walk\n", 0);
    CHECK(contains(own(good + "01_01,50,99999,jump\n", bad_input), "labels.csv:3: "));
}

TEST_CASE("labels that were given are summed up where the table goes to a file", "[input]") {
    const Corpus corpus("frames,features,neighbors,segments,primitives");
    const std::string from = corpus.takes + "/cycles.csv";
    const std::string output = (corpus.folder / "labelled.csv").string();
    const auto told = require_program({"label", corpus.store, "--from", from, "-o", output}).output;
    const auto all = lines_of(text_of(output)).size() - 1;
    CHECK(told.starts_with(std::to_string(all) + " primitives: "));
    CHECK(require_program({"label", corpus.store, "--from", from}).output == text_of(output));
}

TEST_CASE("the neighbours of all clips are written as JSON, and into a pipe as into a file",
          "[input]") {
    const Corpus corpus("frames,features,neighbors");
    const std::string file = (corpus.folder / "out.json").string();
    const std::vector<std::string> words = {"export", corpus.store, "neighbors"};
    const auto lines = lines_of(require_program(words).output);
    auto json = words;
    json.insert(json.end(), {"--format", "json", "-o", file});
    require_program(json);
    const auto rows = lines_of(text_of(file));
    REQUIRE(lines.size() > 3);
    CHECK(rows.front() == "[");
    CHECK(rows.back() == "]");
    CHECK(std::count(rows.begin(), rows.end(), " {") == std::ssize(lines) - 1);
    CHECK(std::count(rows.begin(), rows.end(), " },") == std::ssize(lines) - 2);
}

TEST_CASE("clips are listed by their names, in which there may be commas", "[input]") {
    const TemporaryFolder folder;
    const std::string takes = (folder / "takes").string(), store = (folder / "store").string();
    generate_corpus(takes, 6000, 2, 5);
    fs::rename(takes + "/01/01_01.amc", takes + "/01/one,more.amc");
    require_program(reindex(takes, store, {"--only", "frames,features,pose_hierarchy"}));
    const auto clips = [&](const std::vector<std::string>& words) {
        std::vector<std::string> command = {"compress", store, "-o", (folder / "m").string()};
        for (const std::string& word : words) command.insert(command.end(), {"--clip", word});
        return lines_of(require_program(command).output).front().substr(0, 21);
    };
    CHECK(clips({"one,more"}) == "motion        1 clips");
    CHECK(clips({"01_02,02_01"}) == "motion        2 clips");
    CHECK(clips({"one,more", "02_01"}) == "motion        2 clips");
    CHECK(contains(
        require_program({"compress", store, "--clip", "one,02", "-o", (folder / "m").string()}, 64)
            .errors,
        "no clip 'one' is indexed"));
}

TEST_CASE("errors of the command line are JSON lines where the log is", "[input]") {
    const CommandResult result = run_program({"info", "x", "--log-format", "json", "--oops"});
    CHECK(result.exit_code == usage);
    CHECK(result.errors.starts_with("{"));
    CHECK(contains(result.errors, "--oops"));
    CHECK(lines_of(result.errors).size() == 1);
}
