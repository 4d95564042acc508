// What commands promise on their own: help, tables, summaries, logs, exit codes (design §7).
#include <algorithm>
#include <nlohmann/json.hpp>

#include "small_corpus.h"
#include "store_on_disk.h"

namespace {

constexpr int usage = 64;
const std::vector<std::string> commands = {"reindex", "ingest", "publish", "generate", "info",
                                           "verify",  "gc",     "diff",    "export",   "evaluate"};

struct Letter {
    int64_t first, end, letter;
};

/// Clip → its letters, as `export letters` tells them.
std::map<std::string, std::vector<Letter>> letters_in(const fs::path& store) {
    const CommandResult exported = require_program({"export", store.string(), "letters"});
    const auto records = kinetome::parse_csv(exported.output, "letters");
    REQUIRE(records.at(0).fields == std::vector<std::string>{"clip", "first", "end", "letter"});
    std::map<std::string, std::vector<Letter>> letters;
    for (size_t i = 1; i < records.size(); ++i) {
        const auto& cells = records[i].fields;
        letters[cells.at(0)].push_back(
            {std::stoll(cells.at(1)), std::stoll(cells.at(2)), std::stoll(cells.at(3))});
    }
    return letters;
}

std::map<std::string, int64_t> frames_in(const fs::path& store) {
    const CommandResult exported =
        require_program({"export", store.string(), "clips", "--format", "json"});
    std::map<std::string, int64_t> frames;
    for (const auto& clip : nlohmann::json::parse(exported.output)) {
        frames[clip.at("clip")] = clip.at("frames");
    }
    return frames;
}

}  // namespace

TEST_CASE("every command has help with an example", "[commands]") {
    const CommandResult all = require_program({"--help"});
    for (const std::string& command : commands) {
        INFO(command);
        CHECK(contains(all.output, "\n  " + command + " "));
        const CommandResult help = require_program({command, "--help"});
        CHECK(contains(help.output, "Example:\n  kinetome " + command + " "));
        CHECK(help.errors.empty());
    }
    CHECK(contains(require_program({"--version"}).output, "kinetome "));
}

TEST_CASE("a command line that makes no sense is refused, naming what is wrong", "[commands]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const std::string takes = corpus.path().string(), store = corpus.store().string();
    const std::string config = corpus.folder().write("bad.toml", "clusters = 5\ncolour = 3\n");
    const std::string broken = corpus.folder().write("broken.toml", "clusters = 5\n= 3\n");
    const std::string text = corpus.folder().write("text.toml", "clusters = \"many\"\n");
    struct Mistake {
        std::vector<std::string> words;
        std::string named;
    };
    for (const Mistake& mistake : std::vector<Mistake>{
             {{}, "subcommand"},
             {{"reindx", takes}, "reindx"},
             {{"reindex", takes}, "--store"},
             {{"reindex", "--store", store}, "CORPUS"},
             {{"reindex", takes, "--store", store, "--colour", "3"}, "--colour"},
             {{"reindex", takes, "--store", store, "--only", "frames,colours"}, "'colours'"},
             {{"reindex", takes, "--store", store, "--config", config}, "bad.toml:2: no option"},
             {{"reindex", takes, "--store", store, "--config", broken}, "broken.toml:2: "},
             {{"reindex", takes, "--store", store, "--config", text}, "text.toml:1: clusters"},
             {{"reindex", takes, "--store", store, "--config", "none.toml"}, "none.toml"},
             {{"reindex", takes, "--store", store, "--clusters", "many"}, "clusters"},
             {{"reindex", takes, "--store", store, "--clusters", "-1"}, "clusters"},
             {{"reindex", takes, "--store", store, "--variance-share", "1.5"}, "variance-share"},
             {{"reindex", takes, "--store", store, "--pose-rate", "nan"}, "pose-rate"},
             {{"reindex", takes, "--store", store, "--partition", "some"}, "partition"},
             {{"reindex", takes, "--store", store, "--compression", "zip"}, "compression"},
             {{"reindex", takes, "--store", store, "--shard-frames", "10"}, "shard-frames"},
             {{"reindex", takes, "--store", store, "--threads", "0"}, "threads"},
             {{"reindex", takes, "--store", store, "--memory", "much"}, "much"},
             {{"reindex", takes, "--store", store, "--subject-from", "("}, "subject-from"},
             {{"reindex", takes, "--store", store, "--subject-from", "x"}, "subject-from"},
             {{"reindex", takes, "--store", store, "--log-format", "xml"}, "--log-format"},
             {{"ingest", takes, "--store", store, "--slice", "0/3"}, "--slice 0/3"},
             {{"ingest", takes, "--store", store, "--slice", "4/3"}, "--slice 4/3"},
             {{"ingest", takes, "--store", store, "--slice", "half"}, "--slice half"},
             {{"generate", "--frames", "0", "-o", store}, "--frames"},
             {{"gc", store, "--keep", "0"}, "--keep"},
         }) {
        INFO(joined(mistake.words));
        const CommandResult refused = require_program(mistake.words, usage);
        CHECK(contains(refused.errors, mistake.named));
        CHECK_FALSE(StoreOnDisk(corpus.store()).current());
    }
    corpus.reindex(0);
    for (const Mistake& mistake : std::vector<Mistake>{
             {{"export", store, "colours"}, "there are clips, letters"},
             {{"export", store, "clips", "--format", "xml"}, "xml"},
             {{"info", store, "--generation", "1999"}, "'1999'"},
             {{"diff", store, "current", "nothing"}, "'nothing'"},
         }) {
        INFO(joined(mistake.words));
        CHECK(contains(require_program(mistake.words, usage).errors, mistake.named));
    }
}

TEST_CASE("letters tile every clip from its first to its last frame", "[commands]") {
    const TemporaryFolder folder;
    generate_corpus(folder / "takes", 9000, 4);
    for (const std::string rate : {"120", "60", "100", "240", "119.88"}) {
        INFO("takes at " << rate << " frames a second");
        const fs::path store = folder / ("at-" + rate);
        require_program(reindex(folder / "takes", store, {"--amc-rate", rate}));
        const auto letters = letters_in(store);
        const auto frames = frames_in(store);
        REQUIRE(frames.size() > 3);
        CHECK(letters.size() == frames.size());
        size_t changes = 0;
        for (const auto& [clip, length] : frames) {
            INFO(clip);
            int64_t reached = 0;
            for (const Letter& letter : letters.at(clip)) {
                CHECK(letter.first == reached);
                CHECK(letter.end > letter.first);
                CHECK((letter.letter >= 0 && letter.letter < 60));
                reached = letter.end;
            }
            CHECK(reached == length);
            changes += letters.at(clip).size() - 1;
        }
        CHECK(changes > 3 * frames.size());
    }
}

TEST_CASE("tables say the same in CSV and JSON, on standard output and in a file", "[commands]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.add("good/good_2.amc", "nonsense");
    corpus.reindex(3);
    const std::string store = corpus.store().string();
    for (const std::string what : {"clips", "letters"}) {
        INFO(what);
        const std::string csv = require_program({"export", store, what}).output;
        const auto records = kinetome::parse_csv(csv, what);
        const auto json = nlohmann::json::parse(
            require_program({"export", store, what, "--format", "json"}).output);
        REQUIRE(json.size() + 1 == records.size());
        for (size_t i = 0; i < json.size(); ++i) {
            REQUIRE(json[i].size() == records[0].fields.size());
            for (size_t j = 0; j < records[0].fields.size(); ++j) {
                const auto& value = json[i].at(records[0].fields[j]);
                const std::string cell = records[i + 1].fields[j];
                if (value.is_string()) {
                    CHECK(value.get<std::string>() == cell);
                } else {
                    CHECK(value.get<double>() == std::stod(cell));
                }
            }
        }
        const fs::path file = corpus.folder() / (what + ".csv");
        CHECK(require_program({"export", store, what, "-o", file.string()}).output.empty());
        CHECK(text_of(file) == csv);
    }
    const fs::path nowhere = corpus.folder() / "missing" / "clips.csv";
    require_program({"export", store, "clips", "-o", nowhere.string()}, 73);
}

TEST_CASE("info tells what a store holds", "[commands]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.add_take("good/good_2.amc");
    corpus.add("good/good_3.amc", "nonsense");
    corpus.reindex(3);
    const StoreOnDisk store(corpus.store());
    const std::string output = require_program({"info", store.name()}).output;
    CHECK(contains(output, "generation  " + *store.current() + "\n"));
    CHECK(contains(output, "2 indexed, 1 quarantined, 300 frames"));
    CHECK(contains(output, corpus.path().string()));
    for (const std::string stage :
         {"frames", "features", "pose_clusters", "motion_strings", "bundles", "bundle_graph",
          "pose_hierarchy", "signatures", "neighbors", "segments", "primitives"}) {
        CHECK(contains(output, "\n" + stage + " "));
    }
}

TEST_CASE("gc drops the oldest generations and leaves whole ones", "[commands]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    std::vector<std::string> ids;
    const StoreOnDisk store(corpus.store());
    for (const std::string tau : {"1", "2", "3", "4"}) {
        corpus.reindex(0, {"--tau", tau});
        ids.push_back(*store.current());
    }
    CHECK(std::is_sorted(ids.begin(), ids.end()));
    const std::string digests = store.digests();
    CHECK(contains(require_program({"gc", store.name()}).output, "3 generations left"));
    CHECK_FALSE(store.generations().count(ids[0]));
    const std::string output = require_program({"gc", store.name(), "--keep", "1"}).output;
    CHECK(contains(output, "removed " + ids[1]));
    CHECK(contains(output, "removed " + ids[2]));
    CHECK(store.generations() == std::set<std::string>{ids[3]});
    CHECK(store.digests() == digests);
}

TEST_CASE("gc keeps the current generation even when newer ones are kept", "[commands]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const StoreOnDisk store(corpus.store());
    corpus.reindex(0, {"--tau", "1"});
    const std::string first = *store.current();
    corpus.reindex(0, {"--tau", "2"});
    fs::remove(store.path() / "current");  // a user went back
    fs::create_directory_symlink("generations/" + first, store.path() / "current");
    require_program({"gc", store.name(), "--keep", "1"});
    CHECK(store.generations().count(first) == 1);
    CHECK(run_program({"verify", store.name()}).exit_code == 0);
}

TEST_CASE("diff tells options, files and content that differ, and nothing else", "[commands]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const StoreOnDisk store(corpus.store());
    corpus.reindex(0);
    const std::string first = *store.current();
    corpus.reindex(0, {"--tau", "2"});
    const std::string output =
        require_program({"diff", store.name(), first.substr(0, first.size() - 1), "current"})
            .output;
    CHECK(contains(output, "options:\n  tau: '0' → '2'\n"));
    CHECK(contains(output, "files:\n  motion_strings.h5: option tau was 0, is 2\n"));
    CHECK(contains(output, "/all/tau: differs"));
    CHECK_FALSE(contains(output, "clips"));
    CHECK_FALSE(contains(output, "pose_clusters"));
    CHECK(contains(require_program({"diff", store.name(), first, first}).output, "no difference"));
}

TEST_CASE("the option --quiet leaves warnings and errors alone", "[commands]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    CHECK(corpus.reindex(0, {"--quiet"}).errors.empty());
    const CommandResult warned = corpus.reindex(0, {"--quiet", "--only", "frames", "--tau", "3"});
    for (const std::string& line : lines_of(warned.errors)) CHECK(contains(line, " warning "));
    CHECK_FALSE(warned.errors.empty());
    fs::remove_all(corpus.path());
    CHECK(contains(corpus.reindex(65, {"--quiet"}).errors, " error "));
}

TEST_CASE("with --log-format json, every line is an object, and with --log-file a file has it too",
          "[commands]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const fs::path file = corpus.folder() / "run.log";
    const CommandResult indexed =
        corpus.reindex(0, {"--log-format", "json", "--log-file", file.string()});
    CHECK(text_of(file) == indexed.errors);
    const auto lines = lines_of(indexed.errors);
    REQUIRE(lines.size() > 5);
    for (const std::string& line : lines) {
        const auto object = nlohmann::json::parse(line);
        CHECK(object.at("level") == "info");
        CHECK(object.at("time").get<std::string>().back() == 'Z');
        CHECK_FALSE(object.at("message").get<std::string>().empty());
    }
}

TEST_CASE("the configuration that a generation keeps makes it again", "[commands]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.add_take("good/good_2.amc");
    const StoreOnDisk store(corpus.store());
    require_program(reindex(corpus.path(), store.path(),
                            {"--clusters", "7", "--tau", "0.1", "--subject-from", R"(^([^/"\\]+)/)",
                             "--partition", "subject", "--cluster-rule", "bic", "--bic-clusters",
                             "5,6", "--velocity-reach", "0.1", "--compression", "gzip"}));
    const std::string config = store.file("config.toml").string();
    const CommandResult again = require_program(
        {"reindex", corpus.path().string(), "--store", store.name(), "--config", config});
    CHECK(contains(again.output, "up to date"));
    // Flags stand above the file.
    const CommandResult changed =
        require_program({"reindex", corpus.path().string(), "--store", store.name(), "--config",
                         config, "--tau", "0.2"});
    CHECK(RunLog(changed.errors).names_made() ==
          std::set<std::string>{"motion_strings.h5", "bundles.h5", "bundle_graph.h5"});
}

TEST_CASE("compression alters files, and no digest", "[commands]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.reindex(0);
    const StoreOnDisk store(corpus.store());
    const std::string digests = store.digests();
    const auto bytes = store.artifact_bytes();
    corpus.reindex(0, {"--compression", "gzip"});
    CHECK(store.digests() == digests);
    CHECK(store.artifact_bytes() != bytes);
}

TEST_CASE("one seed generates one corpus, for any number of threads", "[commands]") {
    const TemporaryFolder folder;
    const auto generate = [&](const std::string& name, const std::string& seed,
                              const std::string& threads) {
        const fs::path home = folder / name;
        require_program({"generate", "--frames", "5000", "--subjects", "2", "--seed", seed,
                         "--threads", threads, "-o", home.string()});
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::recursive_directory_iterator(home)) {
            if (entry.is_regular_file())
                files[fs::relative(entry.path(), home)] = text_of(entry.path());
        }
        return files;
    };
    const auto first = generate("first", "5", "1");
    CHECK(first.count("truth.csv") == 1);
    CHECK(first.count("cycles.csv") == 1);
    CHECK(generate("second", "5", "7") == first);
    CHECK(generate("third", "6", "1") != first);
    CHECK(contains(
        require_program({"generate", "--frames", "100", "-o", (folder / "first").string()}, usage)
            .errors,
        "not an empty folder"));
}
