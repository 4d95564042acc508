// Names of files are any bytes: they are never obeyed, and come back as they were (design §8).
#include <nlohmann/json.hpp>

#include "small_corpus.h"
#include "store_on_disk.h"

namespace {

const std::vector<std::string> odd_names = {"with spaces",
                                            "it's",
                                            "say \"hi\"",
                                            "a,b",
                                            "a;b",
                                            "line\nbreak",
                                            "carriage\rreturn",
                                            "tab\there",
                                            "<script>alert(1)<script>",
                                            "&amp;",
                                            "=cmd|' C'!A0",
                                            "+1",
                                            "-1",
                                            "@sum",
                                            "\t=1",
                                            "--help",
                                            "$(touch owned)",
                                            "`touch owned`",
                                            "; touch owned",
                                            "*",
                                            "~",
                                            "%2e%2e%2f",
                                            "..",
                                            "...",
                                            ".hidden",
                                            "\xff\xfe",
                                            "caf\xc3\xa9",
                                            "\xe2\x80\xae"
                                            "reversed",
                                            "\x01",
                                            "\\",
                                            "a\\..\\b",
                                            "{}",
                                            "[0]",
                                            "checkpoint-0",
                                            "con",
                                            "_",
                                            " "};

std::set<std::string> names_in(const std::map<std::string, ClipState>& clips) {
    std::set<std::string> names;
    for (const auto& [name, clip] : clips) names.insert(name);
    return names;
}

}  // namespace

TEST_CASE("takes of any name are indexed and exported under that name", "[names]") {
    SmallCorpus corpus;
    corpus.add_skeleton("odd/odd.asf");
    for (const std::string& name : odd_names) corpus.add_take(fs::path("odd") / (name + ".amc"));
    Command command = program(reindex(corpus.path(), corpus.store(), {"--clusters", "5"}));
    command.folder = corpus.folder().path();
    const CommandResult indexed = run(command);
    INFO(indexed.errors << indexed.output);
    REQUIRE(indexed.exit_code == 0);

    const std::set<std::string> expected(odd_names.begin(), odd_names.end());
    REQUIRE(expected.size() == odd_names.size());
    CHECK(names_in(clips_in(corpus.store())) == expected);

    const auto json = nlohmann::json::parse(
        require_program({"export", corpus.store().string(), "clips", "--format", "json"}).output);
    std::set<std::string> in_json;
    for (const auto& clip : json) in_json.insert(clip.at("clip").get<std::string>());
    std::set<std::string> as_text = expected;
    as_text.erase("\xff\xfe");  // no text: JSON has U+FFFD in its place
    as_text.insert("\xef\xbf\xbd\xef\xbf\xbd");
    CHECK(in_json == as_text);

    const auto letters = kinetome::parse_csv(
        require_program({"export", corpus.store().string(), "letters"}).output, "letters");
    std::set<std::string> in_letters;
    for (size_t i = 1; i < letters.size(); ++i) {
        in_letters.insert(kinetome::from_csv_text(letters[i].fields[0]));
    }
    CHECK(in_letters == expected);
    CHECK(run_program({"verify", corpus.store().string()}).exit_code == 0);

    std::set<std::string> in_folder;
    for (const auto& entry : fs::directory_iterator(corpus.folder().path())) {
        in_folder.insert(entry.path().filename().string());
    }
    CHECK(in_folder == std::set<std::string>{"store", "takes"});  // nothing was obeyed
}

TEST_CASE("no cell of a table begins like a formula", "[names]") {
    SmallCorpus corpus;
    corpus.add_skeleton("=1/=1.asf");
    for (const std::string& name : odd_names) corpus.add_take(fs::path("=1") / (name + ".amc"));
    corpus.add("=1/@broken.amc", "nonsense");
    corpus.reindex(3);
    for (const std::string what : {"clips", "letters"}) {
        const auto records = kinetome::parse_csv(
            require_program({"export", corpus.store().string(), what}).output, what);
        CHECK(records.size() > odd_names.size());
        for (const kinetome::CsvRecord& record : records) {
            for (const std::string& cell : record.fields) {
                if (!cell.empty() && contains("=+-@\t\r", cell.substr(0, 1))) FAIL("cell " << cell);
            }
        }
    }
}

TEST_CASE("folders of any name are subjects of their own", "[names]") {
    SmallCorpus corpus;
    for (const std::string& name : odd_names) {
        if (name == "..") continue;
        corpus.add_skeleton(fs::path(name) / "x.asf");
        corpus.add_take(fs::path(name) / "x_1.amc");
    }
    corpus.reindex(0, {"--partition", "subject"});
    const auto clips = clips_in(corpus.store());
    CHECK(clips.size() == odd_names.size() - 1);
    std::set<std::string> partitions;
    for (const std::string& line : lines_of(StoreOnDisk(corpus.store()).digests())) {
        const std::string suffix = "/weights";
        if (line.size() > suffix.size() &&
            line.compare(line.size() - suffix.size(), suffix.size(), suffix) == 0) {
            partitions.insert(line.substr(line.find("  ")));
        }
    }
    CHECK(partitions.size() == clips.size());
}

TEST_CASE("messages about odd names keep to their line", "[names]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.add("good/line\nbreak \x1b[31m\xff.amc", "nonsense");
    corpus.add("good/\xff.amc", "more nonsense");
    corpus.add("good/dup\n1.amc", corpus.performer().amc);
    corpus.add("good/dup\n2.amc", corpus.performer().amc);
    const CommandResult text = corpus.reindex(3);
    for (const std::string& all : {text.output, text.errors}) {
        CHECK_FALSE(contains(all, "\x1b"));
        CHECK_FALSE(contains(all, "line\nbreak"));
        CHECK_FALSE(contains(all, "dup\n"));
    }
    CHECK(contains(text.output, "line\\x0abreak \\x1b[31m\\xff.amc"));
    CHECK(contains(text.output, "dup\\x0a2.amc: the same content as good/dup\\x0a1.amc"));
    const CommandResult lines = corpus.reindex(3, {"--log-format", "json", "--tau", "4"});
    for (const std::string& line : lines_of(lines.errors)) {
        CHECK(nlohmann::json::parse(line).at("message").is_string());
    }
}

TEST_CASE("takes of one stem are told apart by the shortest path", "[names]") {
    SmallCorpus corpus;
    for (const std::string folder : {"a/x", "b/x", "b/y", "c"}) {
        corpus.add_skeleton(fs::path(folder) / "s.asf");
    }
    corpus.add_take("a/x/take.amc");
    corpus.add_take("b/x/take.amc");
    corpus.add_take("b/y/take.amc");
    corpus.add_take("b/y/other.amc");
    corpus.add_take("c/same.amc");
    corpus.add_take("c/same.AMC");
    corpus.reindex(0);
    const auto clips = clips_in(corpus.store());
    CHECK(names_in(clips) == std::set<std::string>{"a/x/take", "b/x/take", "y/take", "other",
                                                   "c/same.amc", "c/same.AMC"});
    CHECK(clips.at("y/take").source == "b/y/take.amc");
}
