// Takes that cannot be used: each is left out for a reason that helps, and the others go on
// (design §8).
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <functional>

#include "small_corpus.h"
#include "store_on_disk.h"

namespace {

constexpr int some_quarantined = 3, nothing_usable = 65;

using Lines = std::vector<std::string>;

/// Position of the n-th line that begins with `word`.
size_t line_of(const Lines& lines, const std::string& word, int n) {
    for (size_t i = 0; i < lines.size(); ++i) {
        if ((lines[i] == word || lines[i].rfind(word + " ", 0) == 0) && --n == 0) return i;
    }
    throw std::runtime_error("no such line");
}

struct Damage {
    std::string name;
    /// Damages the take and returns the number, from 1, of the line that is to be blamed.
    std::function<size_t(Lines&)> inflict;
    std::string reason;
};

const std::vector<Damage> damages = {
    {"a number is missing",
     [](Lines& lines) {
         const size_t at = line_of(lines, "lowerback", 3);
         lines[at].resize(lines[at].rfind(' '));
         return at + 1;
     },
     "expected 3 numbers of bone 'lowerback', found the end of the line"},
    {"a number too many",
     [](Lines& lines) {
         const size_t at = line_of(lines, "lowerback", 3);
         lines[at] += " 17.5";
         return at + 1;
     },
     "expected the end of the line after 3 numbers of bone 'lowerback', found '17.5'"},
    {"a bone that the skeleton has not",
     [](Lines& lines) {
         const size_t at = line_of(lines, "lowerback", 2);
         lines[at].replace(0, 9, "tail");
         return at + 1;
     },
     "expected a bone of the skeleton, found 'tail'"},
    {"no number",
     [](Lines& lines) {
         const size_t at = line_of(lines, "lowerback", 4);
         lines[at].replace(lines[at].rfind(' ') + 1, std::string::npos, "abc");
         return at + 1;
     },
     "expected a finite number, found 'abc'"},
    {"not a number",
     [](Lines& lines) {
         const size_t at = line_of(lines, "lowerback", 4);
         lines[at].replace(lines[at].rfind(' ') + 1, std::string::npos, "nan");
         return at + 1;
     },
     "expected a finite number, found 'nan'"},
    {"infinite",
     [](Lines& lines) {
         const size_t at = line_of(lines, "root", 5);
         lines[at].replace(lines[at].rfind(' ') + 1, std::string::npos, "1e999");
         return at + 1;
     },
     "expected a finite number, found '1e999'"},
    {"a frame is left out",
     [](Lines& lines) {
         const size_t at = line_of(lines, "7", 1), next = line_of(lines, "8", 1);
         lines.erase(lines.begin() + static_cast<long>(at),
                     lines.begin() + static_cast<long>(next));
         return at + 1;
     },
     "expected frame 7, found '8'"},
    {"cut off in mid-frame",
     [](Lines& lines) {
         lines.resize(line_of(lines, "rfemur", 9));
         return lines.size() + 1;
     },
     "found the end of the file"},
    {"cut off in mid-number",
     [](Lines& lines) {
         lines.resize(line_of(lines, "lowerback", 6) + 1);
         lines.back().resize(lines.back().rfind(' ') + 1);
         return lines.size();
     },
     "expected 3 numbers of bone 'lowerback', found the end of the line"},
    {"empty", [](Lines& lines) { return lines.clear(), size_t{1}; }, "found no frame at all"},
};

}  // namespace

TEST_CASE("a damaged take is left out, naming its line, and the others go on", "[bad take]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.add_skeleton("bad/bad.asf");
    std::map<std::string, std::string> beginnings;
    for (size_t i = 0; i < damages.size(); ++i) {
        Lines lines = lines_of(corpus.another_take());
        const size_t line = damages[i].inflict(lines);
        const std::string clip = "bad_" + std::to_string(i);
        corpus.add("bad/" + clip + ".amc", joined(lines));
        beginnings[clip] = "bad/" + clip + ".amc:" + std::to_string(line) + ": expected ";
    }
    const CommandResult indexed = corpus.reindex(some_quarantined);
    CHECK(contains(indexed.output, "1 indexed (1 new"));
    CHECK(contains(indexed.output, std::to_string(damages.size()) + " quarantined"));
    const auto found = clips_in(corpus.store());
    CHECK(found.at("good_1").state == "indexed");
    for (size_t i = 0; i < damages.size(); ++i) {
        INFO(damages[i].name);
        const auto& [source, state, reason] = found.at("bad_" + std::to_string(i));
        CHECK(state == "quarantined");
        CHECK_THAT(reason, Catch::StartsWith(beginnings["bad_" + std::to_string(i)]));
        CHECK_THAT(reason, Catch::EndsWith(damages[i].reason));
        CHECK(contains(indexed.output, "quarantined: " + reason));
    }
    CHECK(run_program({"verify", corpus.store().string()}).exit_code == 0);
    CHECK(contains(corpus.reindex(some_quarantined).output, "up to date"));
}

TEST_CASE("a take that is mended is indexed by the next run", "[bad take]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const fs::path take = corpus.add("good/good_2.amc", "nonsense");
    corpus.reindex(some_quarantined);
    write_text(take, corpus.another_take());
    CHECK(contains(corpus.reindex(0).output, "2 indexed (1 new, 0 changed, 1 reused)"));
}

TEST_CASE("a take without a skeleton is left out, saying where one was looked for", "[bad take]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.add_take("none/07_3.amc");
    corpus.add_take("two/07_4.amc");
    corpus.add_skeleton("two/x.asf");
    corpus.add_skeleton("two/y.asf");
    corpus.add_take("only/07_5.amc");
    corpus.add_skeleton("only/somebody.asf");
    corpus.add_take("number/07_6.amc");
    corpus.add_skeleton("number/07.asf");
    corpus.add_skeleton("number/08.asf");
    corpus.add_take("stem/07_7.amc");
    corpus.add_skeleton("stem/07_7.asf");
    corpus.add_skeleton("stem/08.asf");
    corpus.reindex(some_quarantined);
    const auto found = clips_in(corpus.store());
    CHECK(found.at("07_3").reason ==
          "none/07_3.amc: no skeleton: looked for 07.asf, 07_3.asf and a single .asf file in its "
          "folder (0 there)");
    CHECK_THAT(found.at("07_4").reason, Catch::EndsWith("(2 there)"));
    for (const std::string clip : {"07_5", "07_6", "07_7"}) {
        CHECK(found.at(clip).state == "indexed");
    }
}

TEST_CASE("a damaged skeleton leaves out its takes and no others", "[bad take]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.add("bad/bad.asf", corpus.performer().asf.substr(0, corpus.performer().asf.size() / 2));
    corpus.add_take("bad/bad_1.amc");
    corpus.add_take("bad/bad_2.amc");
    corpus.reindex(some_quarantined);
    const auto found = clips_in(corpus.store());
    CHECK(found.at("good_1").state == "indexed");
    for (const std::string clip : {"bad_1", "bad_2"}) {
        CHECK(found.at(clip).state == "quarantined");
        CHECK_THAT(found.at(clip).reason, Catch::StartsWith("bad/bad.asf:"));
    }
}

TEST_CASE("an unknown naming scheme is told, and --joint-map heals it", "[bad take]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const auto renamed = [](const std::string& text) {
        Lines lines = lines_of(text);
        for (std::string& line : lines) {
            const size_t at = line.find("head");
            const bool word = at != std::string::npos && (at == 0 || line[at - 1] == ' ') &&
                              (at + 4 == line.size() || line[at + 4] == ' ');
            if (word) line.replace(at, 4, "Kopf");
        }
        return joined(lines);
    };
    corpus.add("odd/odd.asf", renamed(corpus.performer().asf));
    corpus.add("odd/odd_1.amc", renamed(corpus.another_take()));
    corpus.reindex(some_quarantined);
    const std::string reason = clips_in(corpus.store()).at("odd_1").reason;
    CHECK(contains(reason, "unknown joint naming scheme: roles missing: head;"));
    CHECK(contains(reason, "joints found: 'root', "));
    CHECK(contains(reason, "'Kopf'"));
    CHECK(contains(reason, "--joint-map"));

    const fs::path map = corpus.folder().write("map.toml", "head = \"Kopf\"\n");
    corpus.reindex(some_quarantined, {"--joint-map", map.string()});
    CHECK(clips_in(corpus.store()).at("odd_1").state == "indexed");
    // The good rig has no joint of that name, and the map is for all.
    CHECK(contains(clips_in(corpus.store()).at("good_1").reason, "'Kopf'"));

    fs::remove_all(corpus.path() / "good");
    CHECK(contains(corpus.reindex(0, {"--joint-map", map.string()}).output, "1 indexed"));
    corpus.folder().write("map.toml", "head = \"upperneck\"\n");
    CHECK(contains(corpus.reindex(0, {"--joint-map", map.string()}).errors, "joint-map changed"));
    corpus.folder().write("map.toml", "tail = \"Kopf\"\n");
    CHECK(contains(corpus.reindex(64, {"--joint-map", map.string()}).errors, "'tail'"));
    corpus.reindex(64, {"--joint-map", (corpus.folder() / "missing.toml").string()});
}

TEST_CASE("the same content twice counts once, naming the first", "[bad take]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const std::string take = corpus.another_take();
    corpus.add("good/good_3.amc", take);
    corpus.add("good/good_2.amc", take);
    corpus.reindex(some_quarantined);
    const auto found = clips_in(corpus.store());
    CHECK(found.at("good_2").state == "indexed");
    CHECK(found.at("good_3").reason == "good/good_3.amc: the same content as good/good_2.amc");
}

TEST_CASE("a corpus with nothing usable publishes nothing", "[bad take]") {
    SmallCorpus corpus;
    fs::create_directories(corpus.path());
    const StoreOnDisk store(corpus.store());

    CHECK(contains(corpus.reindex(nothing_usable).errors, "no take found"));
    corpus.add("readme.txt", "no takes here");
    CHECK(contains(corpus.reindex(nothing_usable).errors, ".amc"));
    CHECK_FALSE(store.current());

    corpus.add("bad/bad_1.amc", "nonsense");
    CHECK(contains(corpus.reindex(nothing_usable).errors, "none of 1 takes could be indexed"));
    CHECK_FALSE(store.current());
    CHECK(store.generations().empty());

    corpus.add_good_take();
    corpus.reindex(some_quarantined);
    const auto current = store.current();
    fs::remove_all(corpus.path() / "good");
    corpus.reindex(nothing_usable);
    CHECK(store.current() == current);
    fs::remove_all(corpus.path());
    CHECK(contains(corpus.reindex(nothing_usable).errors, "No such file or directory"));
    CHECK(store.current() == current);
}

TEST_CASE("what is named like a take but is no file is passed over and never waited for",
          "[bad take]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const fs::path folder = corpus.path() / "good";
    REQUIRE(::mkfifo((folder / "pipe.amc").c_str(), 0600) == 0);
    REQUIRE(::mkfifo((folder / "pipe.asf").c_str(), 0600) == 0);
    fs::create_directory(folder / "folder.amc");
    fs::create_symlink("nowhere", folder / "dangling.amc");
    fs::create_symlink("itself.amc", folder / "itself.amc");
    fs::create_directory_symlink("..", folder / "loop");
    fs::create_symlink("/dev/zero", folder / "endless.amc");
    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string name = (folder / "socket.amc").string();
    REQUIRE(name.size() < sizeof address.sun_path);
    name.copy(address.sun_path, name.size());
    REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);

    const CommandResult indexed = corpus.reindex(0);
    ::close(socket);
    CHECK(contains(indexed.output, "1 indexed"));
    CHECK(clips_in(corpus.store()).size() == 1);
}

TEST_CASE("takes and folders that may not be read are left out, with the reason", "[bad take]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const fs::path take = corpus.add_take("good/good_2.amc");
    corpus.add_skeleton("closed/closed.asf");
    corpus.add_take("closed/closed_1.amc");
    corpus.add_take("blind/blind_1.amc");
    const fs::path skeleton = corpus.add_skeleton("blind/blind.asf");
    fs::permissions(take, fs::perms::none);
    fs::permissions(skeleton, fs::perms::none);
    fs::permissions(corpus.path() / "closed", fs::perms::none);
    Command command = program(reindex(corpus.path(), corpus.store(), {"--clusters", "5"}));
    command.as_ordinary_user = true;
    const CommandResult indexed = run(command);
    fs::permissions(corpus.path() / "closed", fs::perms::owner_all);
    INFO(indexed.errors);
    REQUIRE(indexed.exit_code == some_quarantined);

    const auto found = clips_in(corpus.store());
    CHECK(found.at("good_1").state == "indexed");
    CHECK(contains(found.at("good_2").reason, "good_2.amc: cannot be read: Permission denied"));
    CHECK(contains(found.at("blind_1").reason, "blind.asf: cannot be read: Permission denied"));
    CHECK(contains(found.at("closed/").reason, "folder cannot be read: Permission denied"));
}
