#include "kinetome/store/catalog.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "kinetome/base/error.h"

using namespace kinetome;
using Catch::Contains;

namespace {

CatalogClip indexed_clip(const std::string& name) {
    CatalogClip clip;
    clip.name = name;
    clip.id = clip_id(name);
    clip.source = "subject/" + name + ".amc";
    clip.content = digest_of(name);
    clip.skeleton_source = "subject/" + name + ".asf";
    clip.claimed_frames = 401;
    clip.frames = 400;
    clip.rate = 119.88011988011988;
    clip.clip_class = "31j62d-4f2a";
    clip.capabilities = {"angles", "effectors"};
    clip.shard = "9c";
    clip.skipped = {{"markers", "no markers: " + name}};
    clip.warnings = {name + " is slower than 120 Hz"};
    return clip;
}

CatalogClip quarantined_clip(const std::string& name, const std::string& reason) {
    CatalogClip clip;
    clip.name = name;
    clip.id = clip_id(name);
    clip.quarantined = reason;
    return clip;
}

void check_equal(const CatalogClip& a, const CatalogClip& b) {
    CHECK(a.name == b.name);
    CHECK(a.id == b.id);
    CHECK(a.source == b.source);
    CHECK(a.content == b.content);
    CHECK(a.skeleton_source == b.skeleton_source);
    CHECK(a.claimed_frames == b.claimed_frames);
    CHECK(a.frames == b.frames);
    CHECK(a.rate == b.rate);
    CHECK(a.clip_class == b.clip_class);
    CHECK(a.capabilities == b.capabilities);
    CHECK(a.shard == b.shard);
    CHECK(a.quarantined == b.quarantined);
    CHECK(a.skipped == b.skipped);
    CHECK(a.warnings == b.warnings);
}

Catalog read_back(const Catalog& catalog) {
    return parse_catalog(write_catalog(catalog), "catalog.json");
}

}  // namespace

TEST_CASE("a catalog comes back as it was written, whatever bytes the names of files hold") {
    Catalog catalog;
    catalog.corpus = "../takes/\xFF \xC3";
    for (const std::string name :
         {"02_01", "a \"quoted\" take", "two\nlines", "../../etc/passwd",
          "<script>alert(1)</script>", "=cmd", "not UTF-8: \x80\xFE\xFF", "cut short: \xE2\x82",
          "\xC3\x9C"
          "bung",
          "100%41", "\xEE\xBE\x80 is a code point of private use", "C:\\takes\\1", "\x01\x1F\x7F",
          "\\u00ff"}) {
        catalog.clips.push_back(indexed_clip(name));
        catalog.clips.push_back(quarantined_clip(name + "!", name + ":3: expected a number"));
        catalog.removed.push_back(name);
    }
    const Catalog back = read_back(catalog);
    CHECK(back.corpus == catalog.corpus);
    CHECK(back.removed == catalog.removed);
    REQUIRE(back.clips.size() == catalog.clips.size());
    for (size_t i = 0; i < back.clips.size(); ++i) check_equal(back.clips[i], catalog.clips[i]);
    CHECK(write_catalog(back) == write_catalog(catalog));
}

TEST_CASE("an empty catalog comes back empty") {
    const Catalog back = read_back({});
    CHECK(back.clips.empty());
    CHECK(back.removed.empty());
    CHECK(back.frames() == 0);
}

TEST_CASE("each clip has one line, so that two catalogs can be compared by diff") {
    Catalog catalog;
    catalog.clips = {indexed_clip("a"), indexed_clip("two\nlines"), indexed_clip("c")};
    const std::string text = write_catalog(catalog);
    constexpr int other_lines = 4;
    CHECK(std::count(text.begin(), text.end(), '\n') == 3 + other_lines);
    CHECK_THAT(text, Contains("\n{\"name\":\"two\\nlines\","));
}

TEST_CASE("indexed and quarantined clips add up to all clips") {
    Catalog catalog;
    catalog.clips = {indexed_clip("a"), quarantined_clip("b", "empty"), indexed_clip("c")};
    CHECK(catalog.indexed() == 2);
    CHECK(catalog.quarantined() == 1);
    CHECK(catalog.frames() == 800);
}

TEST_CASE("a damaged catalog is refused, naming the file") {
    Catalog catalog;
    catalog.clips = {indexed_clip("a"), indexed_clip("b")};
    const std::string whole = write_catalog(catalog);
    for (size_t length = 0; length + 2 < whole.size(); length += 7) {
        INFO("cut after " << length << " bytes");
        CHECK_THROWS_WITH(parse_catalog(whole.substr(0, length), "a/catalog.json"),
                          Contains("a/catalog.json"));
        CHECK_THROWS_AS(parse_catalog(whole.substr(0, length), "a/catalog.json"), StoreError);
    }
    for (const std::string json :
         {"[]", "{}", "null", R"({"kinetome_format":1,"corpus":3,"clips":[],"removed":[]})",
          R"({"kinetome_format":1,"corpus":"","clips":[{"name":"a"}],"removed":[]})"}) {
        CHECK_THROWS_AS(parse_catalog(json, "catalog.json"), StoreError);
    }
    std::string no_digest = whole;
    no_digest.replace(no_digest.find(digest_of("a").hex()), 1, "x");
    CHECK_THROWS_AS(parse_catalog(no_digest, "catalog.json"), StoreError);
    CHECK_THROWS_WITH(parse_catalog(no_digest, "a/catalog.json"), Contains("a/catalog.json"));
}

TEST_CASE("a catalog of a newer format is refused, saying so") {
    CHECK_THROWS_WITH(parse_catalog(R"({"kinetome_format":2,"something":"new"})", "catalog.json"),
                      Contains("newer Kinetome (format 2, this one knows up to 1)"));
}

TEST_CASE("a clip's id is exact in JavaScript and depends on the name alone") {
    std::set<int64_t> ids;
    for (int i = 0; i < 10'000; ++i) ids.insert(clip_id("take_" + std::to_string(i)));
    CHECK(ids.size() == 10'000);
    CHECK(*ids.begin() >= 0);
    CHECK(*ids.rbegin() < (int64_t{1} << 53));
    CHECK(*ids.rbegin() > (int64_t{1} << 52));
    CHECK(clip_id("02_01") == static_cast<int64_t>(hash_name("02_01") >> 11));
}
