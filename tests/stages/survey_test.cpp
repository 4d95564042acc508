#include "kinetome/stages/survey.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <set>

#include "kinetome/base/error.h"
#include "support/temporary_folder.h"

using namespace kinetome;
namespace fs = std::filesystem;

namespace {

void write(const fs::path& path, const std::string& text) {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
}

const std::string two_frames =
    ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\n2\nroot 0 0 0 0 0 1\n";

const Take& take_named(const Survey& survey, const std::string& name) {
    const auto found = std::find_if(survey.takes.begin(), survey.takes.end(),
                                    [&](const Take& take) { return take.name == name; });
    if (found == survey.takes.end()) FAIL("no take is called " << name);
    return *found;
}

}  // namespace

TEST_CASE("a take is called by its stem, wherever it lies") {
    CHECK(name_takes({"02/02_01.amc", "deep/down/03/03_01.amc"}) ==
          std::vector<std::string>{"02_01", "03_01"});
}

TEST_CASE("equal stems get the shortest paths that tell them apart, others keep their stem") {
    CHECK(name_takes({"a/x/walk.amc", "b/x/walk.amc", "b/y/walk.amc", "b/run.amc"}) ==
          std::vector<std::string>{"a/x/walk", "b/x/walk", "y/walk", "run"});
    CHECK(name_takes({"walk.amc", "a/walk.amc"}) == std::vector<std::string>{"walk", "a/walk"});
}

TEST_CASE("files that differ in their extension alone are told apart by it") {
    CHECK(name_takes({"a/walk.amc", "a/walk.bvh", "a/run.amc"}) ==
          std::vector<std::string>{"a/walk.amc", "a/walk.bvh", "run"});
}

TEST_CASE("no two takes ever share a name") {
    const std::vector<std::string> paths = {"w.amc",     "a/w.amc",   "a/a/w.amc", "b/a/w.amc",
                                            "a/a/w.bvh", "c/w.d.amc", "c/w.d",     "a/b/a/w.amc"};
    const auto names = name_takes(paths);
    CHECK(std::set<std::string>(names.begin(), names.end()).size() == paths.size());
}

TEST_CASE("a skeleton is looked for by number, by stem, then alone in the folder") {
    const TemporaryFolder folder;
    write(folder.path() / "a/02.asf", "by number");
    write(folder.path() / "a/02_01.asf", "by stem");
    write(folder.path() / "a/02_01.amc", two_frames);
    write(folder.path() / "b/03_01.asf", "by stem");
    write(folder.path() / "b/other.asf", "another");
    write(folder.path() / "b/03_01.amc", two_frames + "\n");
    write(folder.path() / "c/alone.asf", "alone");
    write(folder.path() / "c/04_01.amc", two_frames + "\n\n");
    write(folder.path() / "d/one.asf", "one of two");
    write(folder.path() / "d/two.asf", "two of two");
    write(folder.path() / "d/05_01.amc", two_frames + "\n\n\n");
    const Survey survey = survey_corpus(folder.path(), 2, Log(), {});
    CHECK(take_named(survey, "02_01").skeleton_source == "a/02.asf");
    CHECK(take_named(survey, "03_01").skeleton_source == "b/03_01.asf");
    CHECK(take_named(survey, "04_01").skeleton_source == "c/alone.asf");
    const std::string reason = take_named(survey, "05_01").quarantined;
    CHECK_THAT(reason, Catch::Contains("05.asf") && Catch::Contains("05_01.asf") &&
                           Catch::Contains("2 there"));
}

TEST_CASE("content changes with the skeleton, though the take's bytes are the same") {
    const TemporaryFolder folder;
    write(folder.path() / "02.asf", "short legs");
    write(folder.path() / "02_01.amc", two_frames);
    const Digest before = survey_corpus(folder.path(), 1, Log(), {}).takes.at(0).content;
    write(folder.path() / "02.asf", "long legs");
    const Survey after = survey_corpus(folder.path(), 1, Log(), {});
    CHECK(after.takes.at(0).content != before);
    CHECK(after.takes.at(0).claimed_frames == 2);
}

TEST_CASE("a loop of linked folders is walked once") {
    const TemporaryFolder folder;
    write(folder.path() / "a/02.asf", "skeleton");
    write(folder.path() / "a/02_01.amc", two_frames);
    fs::create_directory_symlink("..", folder.path() / "a/loop");
    CHECK(survey_corpus(folder.path(), 1, Log(), {}).takes.size() == 1);
}

TEST_CASE("a folder without a take is refused, not indexed as empty") {
    const TemporaryFolder folder;
    write(folder.path() / "readme.txt", "no motion here");
    CHECK_THROWS_WITH(survey_corpus(folder.path(), 1, Log(), {}), Catch::Contains("no take found"));
}
