// What `cmake --install` puts into a prefix is enough for its users.
#include "end_to_end/small_corpus.h"
#include "end_to_end/store_on_disk.h"

namespace {

CommandResult require_cmake(std::vector<std::string> words) {
    words.insert(words.begin(), KINETOME_CMAKE);
    CommandResult result = run({.words = std::move(words), .time_limit = 300});
    INFO(result.output << result.errors);
    REQUIRE(result.exit_code == 0);
    return result;
}

}  // namespace

TEST_CASE("a project elsewhere finds the installed package, builds with it and runs", "[install]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.reindex(0);
    const TemporaryFolder folder;
    const fs::path prefix = folder / "prefix", build = folder / "build";
    require_cmake({"--install", KINETOME_BUILD, "--prefix", prefix.string()});
    require_cmake({"-G", "Ninja", "-S", KINETOME_CONSUMER, "-B", build.string(),
                   "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_PREFIX_PATH=" + prefix.string(),
                   "-DCMAKE_CXX_COMPILER=" KINETOME_COMPILER});
    require_cmake({"--build", build.string()});

    const fs::path jobs = prefix / "share" / "kinetome" / "jobs";
    CHECK(contains(run({.words = {jobs / "submit.sh", "--help"}}).output, "--max-requeues"));

    const std::vector<std::string> store = {corpus.store().string()};
    const CommandResult consumer = run({.words = {(build / "consumer").string(), store[0]}});
    CHECK(consumer.exit_code == 0);
    const CommandResult installed =
        run({.words = {(prefix / "bin" / "kinetome").string(), "export", store[0], "letters"}});
    CHECK(installed.exit_code == 0);
    CHECK(consumer.output == installed.output);
    CHECK(contains(consumer.output, "\ngood_1,0,"));
}
