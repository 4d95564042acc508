// What is unchanged is not made again, and what depends on a change is (design §4).
#include <nlohmann/json.hpp>

#include "store_on_disk.h"
#include "support/temporary_folder.h"
#include "takes.h"

namespace {

using Names = std::set<std::string>;

/// A corpus in several shards, indexed once.
struct IndexedCorpus {
    explicit IndexedCorpus(int frames = 24000) {
        generate_corpus(corpus, frames, 3);
        require_program(reindex(corpus, store.path()));
        REQUIRE(store.artifacts("frames-").size() > 2);
    }
    CommandResult again(const std::vector<std::string>& more = {}) const {
        return require_program(reindex(corpus, store.path(), more));
    }

    TemporaryFolder folder;
    fs::path corpus = folder / "takes";
    StoreOnDisk store{folder / "store"};
    fs::path guest = corpus / "01" / "01_99.amc";
};

Names names_of(const std::map<std::string, ino_t>& files) {
    Names names;
    for (const auto& [name, inode] : files) names.insert(name);
    return names;
}

/// Files that are not the very same file as before.
Names replaced(const std::map<std::string, ino_t>& before,
               const std::map<std::string, ino_t>& after) {
    Names names;
    for (const auto& [name, inode] : after) {
        const auto earlier = before.find(name);
        if (earlier == before.end() || earlier->second != inode) names.insert(name);
    }
    return names;
}

Names beginning_with(const Names& names, const std::string& beginning) {
    Names chosen;
    for (const std::string& name : names) {
        if (name.rfind(beginning, 0) == 0) chosen.insert(name);
    }
    return chosen;
}

/// Artifacts of a stage and of those that depend on it.
Names from_stage_on(const StoreOnDisk& store, const std::string& stage) {
    const std::map<std::string, std::vector<std::string>> made_of = {
        {"frames", {"features"}},
        {"features", {"pose_clusters", "pose_hierarchy", "neighbors"}},
        {"neighbors", {"segments"}},
        {"segments", {"primitives"}},
        {"pose_hierarchy", {"signatures"}},
        {"pose_clusters", {"motion_strings"}},
        {"motion_strings", {"bundles"}},
        {"bundles", {"bundle_graph"}}};
    Names names = store.artifacts(stage);
    const auto next = made_of.find(stage);
    if (next == made_of.end()) return names;
    for (const std::string& one : next->second) names.merge(from_stage_on(store, one));
    return names;
}

void flip_bit(const fs::path& file, size_t byte) {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(byte));
    const char changed = static_cast<char>(stream.get() ^ 0x20);
    stream.seekp(static_cast<std::streamoff>(byte));
    stream.put(changed);
    stream.close();
    REQUIRE(stream);
}

}  // namespace

TEST_CASE("with nothing changed, nothing is made and nothing published", "[incremental]") {
    const IndexedCorpus indexed;
    const auto generations = indexed.store.generations();
    const auto inodes = indexed.store.artifact_inodes();
    const CommandResult second = indexed.again();
    const RunLog log(second.errors);
    CHECK(log.made.empty());
    CHECK(log.reused == indexed.store.artifacts());
    CHECK(contains(second.output, "up to date"));
    CHECK(indexed.store.generations() == generations);
    CHECK(indexed.store.artifact_inodes() == inodes);
    CHECK(contains(indexed.again({"--threads", "1"}).output, "up to date"));
    CHECK(contains(indexed.again({"--memory", "1G"}).output, "up to date"));
}

TEST_CASE("a new take alters one shard and what is made of all of them", "[incremental]") {
    const IndexedCorpus indexed;
    const auto before = indexed.store.artifact_inodes();
    const std::string first_generation = *indexed.store.current();
    write_text(indexed.guest, shifted_take(text_of(indexed.corpus / "01" / "01_01.amc"), 30));
    const CommandResult added = indexed.again();
    const auto after = indexed.store.artifact_inodes();

    const Names altered = replaced(before, after);
    CHECK(beginning_with(altered, "frames-").size() == 1);
    CHECK(beginning_with(altered, "features-").size() == 1);
    CHECK(beginning_with(altered, "neighbors-").size() == 1);
    CHECK(altered.size() == 11);
    CHECK(names_of(after) == names_of(before));
    const RunLog log(added.errors);
    CHECK(log.names_made() == altered);
    CHECK(contains(log.made.at(*beginning_with(altered, "frames-").begin()), "takes changed"));
    CHECK(contains(added.output, "(1 new, 0 changed, "));

    const CommandResult difference =
        require_program({"diff", indexed.store.name(), first_generation, "current"});
    CHECK(contains(difference.output, "clips added:\n  01_99\n"));
    CHECK_FALSE(contains(difference.output, "clips changed"));
}

TEST_CASE("a take that is gone is listed as removed, once", "[incremental]") {
    const IndexedCorpus indexed;
    const std::string first_generation = *indexed.store.current();
    fs::remove(indexed.corpus / "02" / "02_02.amc");
    CHECK(contains(indexed.again().output, "1 removed"));
    const auto removed = [&] {
        return nlohmann::json::parse(text_of(indexed.store.file("catalog.json"))).at("removed");
    };
    CHECK(removed() == nlohmann::json::array({"02_02"}));
    CHECK(contains(
        require_program({"diff", indexed.store.name(), first_generation, "current"}).output,
        "clips removed:\n  02_02\n"));
    CHECK_FALSE(
        contains(require_program({"export", indexed.store.name(), "clips"}).output, "02_02"));
    CHECK(contains(indexed.again().output, "0 removed"));
}

TEST_CASE("a take of other content counts as changed", "[incremental]") {
    const IndexedCorpus indexed;
    const std::string first_generation = *indexed.store.current();
    const fs::path take = indexed.corpus / "03" / "03_01.amc";
    write_text(take, shifted_take(text_of(take), 10));
    CHECK(contains(indexed.again().output, "(0 new, 1 changed, "));
    CHECK(contains(
        require_program({"diff", indexed.store.name(), first_generation, "current"}).output,
        "clips changed:\n  03_01\n"));
}

TEST_CASE("another skeleton changes the takes that it belongs to", "[incremental]") {
    const IndexedCorpus indexed;
    const fs::path asf = indexed.corpus / "02" / "02.asf";
    size_t takes = 0;
    for (const auto& entry : fs::directory_iterator(indexed.corpus / "02")) {
        takes += entry.path().extension() == ".amc";
    }
    write_text(asf, "# measured again\n" + text_of(asf));
    CHECK(contains(indexed.again().output, "(0 new, " + std::to_string(takes) + " changed, "));
}

TEST_CASE("an option redoes only what depends on it, and the log tells which", "[incremental]") {
    const IndexedCorpus indexed;
    struct Change {
        std::string option, value, stage, why;
    };
    for (const Change& change : {
             Change{"--tau", "5.5", "motion_strings", "option tau was 0, is 5.5"},
             Change{"--longest-submotion", "1", "motion_strings",
                    "option longest-submotion was 1.6666666666666667, is 1"},
             Change{"--leaf-tolerance", "25", "pose_hierarchy",
                    "option leaf-tolerance was 20, is 25"},
             Change{"--tau-quantile", "0.5", "motion_strings",
                    "option tau-quantile was 0.75, is 0.5"},
             Change{"--spread", "closure", "bundles", "option spread was depth:1, is closure"},
             Change{"--step-quantile", "1", "bundles", "option step-quantile was 0.75, is 1"},
             Change{"--member-length", "mean", "bundles", "option member-length was seed, is mean"},
             Change{"--radius", "60", "neighbors", "option radius was 72, is 60"},
             Change{"--method", "region-growing", "segments",
                    "option method was repetition, is region-growing"},
             Change{"--clusters", "61", "pose_clusters", "option clusters was 60, is 61"},
             Change{"--seed", "9", "pose_clusters", "option seed was"},
             Change{"--partition", "subject", "pose_clusters",
                    "option partition was auto, is subject"},
             Change{"--velocity-reach", "0.02", "features",
                    "option velocity-reach was 0.016666666666666666, is 0.02"},
             Change{"--amc-rate", "60", "frames", "option amc-rate was 120, is 60"},
         }) {
        INFO(change.option << " " << change.value);
        const StoreOnDisk copy(indexed.folder / "copy");
        fs::copy(indexed.store.path(), copy.path(),
                 fs::copy_options::recursive | fs::copy_options::copy_symlinks);
        const RunLog log(
            require_program(reindex(indexed.corpus, copy.path(), {change.option, change.value}))
                .errors);
        CHECK(log.names_made() == from_stage_on(copy, change.stage));
        for (const std::string& name : copy.artifacts(change.stage)) {
            CHECK(contains(log.made.at(name), change.why));
        }
        fs::remove_all(copy.path());
    }
}

TEST_CASE("the option --only makes the stages it names, and says what is left out",
          "[incremental]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 12000, 2);
    const StoreOnDisk store(folder / "store"), fresh(folder / "fresh");
    const CommandResult some =
        require_program(reindex(corpus, store.path(), {"--only", "frames,features"}));
    CHECK(store.artifacts("pose_clusters").empty());
    CHECK_FALSE(store.artifacts("features-").empty());
    CHECK(contains(some.errors, "pose_clusters: not complete, left out"));

    const CommandResult too_far =
        require_program(reindex(corpus, store.path(), {"--only", "motion_strings"}), 64);
    CHECK(contains(too_far.errors, "motion_strings needs pose_clusters.h5"));

    const RunLog rest(require_program(reindex(corpus, store.path())).errors);
    Names left = store.artifacts("neighbors-");
    left.merge(Names{"motion_strings.h5", "pose_clusters.h5", "bundles.h5", "bundle_graph.h5",
                     "pose_hierarchy.h5", "signatures.h5", "segments.h5", "primitives.h5"});
    CHECK(rest.names_made() == left);
    require_program(reindex(corpus, fresh.path()));
    CHECK(store.digests() == fresh.digests());
}

TEST_CASE("with --only, no artifact is published that is older than what it was made of",
          "[incremental]") {
    const IndexedCorpus indexed;
    write_text(indexed.guest, shifted_take(text_of(indexed.corpus / "01" / "01_01.amc"), 30));
    indexed.again({"--only", "frames"});
    CHECK(indexed.store.artifacts("pose_clusters").empty());
    CHECK(indexed.store.artifacts() == indexed.store.artifacts("frames-"));
}

TEST_CASE("a damaged artifact is found out by verify and made again by reindex", "[incremental]") {
    const IndexedCorpus indexed;
    const std::string digests = indexed.store.digests();
    for (const std::string& name :
         {*indexed.store.artifacts("frames-").begin(),
          *indexed.store.artifacts("features-").begin(), std::string("pose_clusters.h5"),
          *indexed.store.artifacts("neighbors-").begin()}) {
        INFO(name);
        const fs::path file = indexed.store.file(name);
        flip_bit(file, fs::file_size(file) / 2);
        const CommandResult verified = require_program({"verify", indexed.store.name()}, 74);
        CHECK(contains(verified.errors, name + ": damaged"));
        CHECK(contains(verified.errors, "in /"));  // the dataset

        const RunLog log(indexed.again().errors);
        CHECK(log.names_made() == Names{name});
        CHECK(contains(log.made.at(name), "is damaged"));
        CHECK(indexed.store.digests() == digests);
    }
}

TEST_CASE("with --copy, generations share no file", "[incremental]") {
    const IndexedCorpus indexed;
    const auto before = indexed.store.artifact_inodes();
    const std::string first_generation = *indexed.store.current();
    indexed.again({"--copy", "--tau", "5"});
    CHECK(*indexed.store.current() != first_generation);
    CHECK(replaced(before, indexed.store.artifact_inodes()) == indexed.store.artifacts());
}
