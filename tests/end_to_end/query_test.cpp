// What `query`, `compress` and `decompress` promise on the command line.
#include "program.h"
#include "store_on_disk.h"
#include "support/temporary_folder.h"
#include "takes.h"

namespace {

struct SignedStore {
    TemporaryFolder folder;
    std::string path = (folder / "store").string();
    SignedStore() {
        generate_corpus(folder / "takes", 6000, 1);
        require_program(reindex(folder / "takes", path,
                                {"--only", "frames,features,pose_hierarchy,signatures"}));
    }
    std::string file(const std::string& name) const { return (folder / name).string(); }
};

}  // namespace

TEST_CASE("query answers in rows, nearest first, and refuses what it cannot look for", "[query]") {
    const SignedStore store;
    const auto query = [&](std::vector<std::string> more, int expected = 0) {
        more.insert(more.begin(), {"query", store.path});
        return require_program(more, expected);
    };
    const auto lines =
        lines_of(query({"--clip", "01_01", "--frames", "20:260", "-k", "3", "--rerank"}).output);
    REQUIRE(lines.size() == 4);
    CHECK(lines[0] == "rank,clip,first,end,distance");
    CHECK(lines[1].starts_with("1,01_01,20,260,"));
    CHECK(lines[3].starts_with("3,"));
    const std::string take = store.file("takes/01/01_01.amc");
    CHECK(contains(query({"--file", take, "--frames", "20:260"}).output, "\n1,01_01,"));
    CHECK(contains(query({"--clip", "01_01", "--frames", "9"}, 64).errors, "expected A:B"));
    CHECK(contains(query({"--clip", "x"}, 64).errors, "no clip"));
    CHECK(contains(query({}, 64).errors, "--clip"));
    CHECK(contains(query({"--clip", "01_01", "--match-rule", "x"}, 64).errors, "pace"));
    CHECK(contains(require_program({"export", store.path, "signatures"}).output,
                   "clip,first,end,leaf\n01_01,0,"));
}

TEST_CASE("compressed motion comes back as BVH, and both last lines tell what it cost", "[query]") {
    const SignedStore store;
    const std::string motion = store.file("one.motion"), bvh = store.file("one.bvh");
    const auto made =
        lines_of(require_program({"compress", store.path, "--clip", "01_01", "-o", motion}).output);
    CHECK(made.back().starts_with("ratio "));
    CHECK(contains(made.back(), " rms_mm "));
    CHECK(contains(made.back(), " max_mm "));
    const auto played =
        lines_of(require_program({"decompress", motion, "--frames", "30:70", "-o", bvh}).output);
    CHECK(played.back() == made.back());
    CHECK(contains(text_of(bvh), "Frames: 40\n"));
    CHECK(contains(require_program({"decompress", motion, "-o", "x.txt"}, 64).errors, ".bvh"));
    CHECK(contains(
        require_program({"decompress", store.file("takes/01/01.asf"), "-o", bvh}, 74).errors,
        "no compressed motion"));
}
