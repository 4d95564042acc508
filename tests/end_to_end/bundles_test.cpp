// What `bundles` with options and `query --bundle` promise.
#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "small_corpus.h"
#include "store_on_disk.h"
#include "support/temporary_folder.h"
#include "takes.h"

namespace {

constexpr int usage = 64, cannot_create = 73;
const std::string stages_of_bundles =
    "frames,features,pose_clusters,motion_strings,bundles,bundle_graph";

std::vector<std::string> bundles_again(const StoreOnDisk& store, std::vector<std::string> more) {
    std::vector<std::string> words = {"bundles", store.name()};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    return cells;
}

/// Rows of a table without its header.
std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    for (const std::string& line : lines_of(csv)) rows.push_back(cells_of(line));
    rows.erase(rows.begin());
    return rows;
}

}  // namespace

TEST_CASE("bundles made again over a store are those of a run with the same options", "[bundles]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 12000, 2);
    // One take that cannot be read, and one that the survey leaves out.
    write_text(corpus / "01" / "broken.amc", ":DEGREES\n1\nroot 1 2\n");
    fs::copy_file(corpus / "01" / "01_01.amc", corpus / "01" / "twice.amc");
    const StoreOnDisk store(folder / "store"), fresh(folder / "fresh");
    const std::vector<std::string> options = {"--rho", "2", "--gamma", "0.5"};
    const auto only = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"--only", stages_of_bundles});
        return more;
    };
    require_program(reindex(corpus, store.path(), only({})), 3);
    require_program(reindex(corpus, fresh.path(), only(options)), 3);
    fs::rename(corpus, folder / "taken away");  // takes are not read again

    const std::string listed = require_program({"bundles", store.name()}).output;
    const std::string before = *store.current();
    const CommandResult again = require_program(bundles_again(store, options));
    CHECK(RunLog(again.errors).names_made() ==
          std::set<std::string>{"bundles.h5", "bundle_graph.h5"});
    CHECK(contains(again.errors, "bundles.h5: to be made: option rho was 1, is 2"));
    CHECK(again.output == require_program({"bundles", fresh.name()}).output);
    CHECK(again.output != listed);
    CHECK(store.digests() == fresh.digests());
    CHECK(text_of(store.file("config.toml")) == text_of(fresh.file("config.toml")));
    require_program({"verify", store.name()});
    CHECK(require_program({"bundles", store.name(), "--generation", before}).output == listed);

    // The same again is nothing new; and what was not asked for stays.
    const auto generations = store.generations();
    CHECK(contains(require_program(bundles_again(store, {"--rho", "2"})).errors, "is up to date"));
    CHECK(store.generations() == generations);

    for (const std::string rho : {"0", "17"}) {
        CHECK(contains(require_program(bundles_again(store, {"--rho", rho}), usage).errors,
                       "rho must be above 0 and at most 16"));
    }
    CHECK(contains(
        require_program(bundles_again(store, {"--rho", "1", "--generation", before}), usage).errors,
        "--generation is of no use"));
    CHECK(store.generations() == generations);

    // A reindex of the same takes goes on from there.
    fs::rename(folder / "taken away", corpus);
    CHECK(contains(require_program(reindex(corpus, store.path(), only(options)), 3).errors,
                   "is up to date"));
}

TEST_CASE("bundles made again are resumed, and disturb no other run", "[bundles]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 12000, 2);
    const StoreOnDisk store(folder / "store"), whole(folder / "whole");
    require_program(reindex(corpus, store.path(), {"--only", stages_of_bundles}));
    require_program(
        reindex(corpus, whole.path(), {"--only", stages_of_bundles, "--spread", "depth:3"}));

    const auto spread = bundles_again(store, {"--spread", "depth:3"});
    Process process(program(spread));
    wait_until([&] { return fs::exists(store.run_folder() / "run.json") || process.ended(); });
    process.signal(SIGKILL);
    process.wait();
    require_program({"verify", store.name()});
    require_program(spread);
    CHECK(store.digests() == whole.digests());

    // Of a run for other takes or options what is finished would be lost.
    require_program({"plan", corpus.string(), "--store", store.name(), "--open", "--clusters", "61",
                     "--shard-frames", "8192"});
    CHECK(contains(require_program(bundles_again(store, {"--rho", "2"}), cannot_create).errors,
                   "another run is in progress"));
    require_program({"bundles", store.name()});
}

TEST_CASE("bundles are made of letters that are there", "[bundles]") {
    const TemporaryFolder folder;
    generate_corpus(folder / "takes", 3000, 1);
    const StoreOnDisk store(folder / "store");
    require_program(reindex(folder / "takes", store.path(), {"--only", "frames,features"}));
    const CommandResult refused = require_program(bundles_again(store, {"--rho", "2"}), usage);
    CHECK(contains(refused.errors, "motion_strings needs pose_clusters.h5"));
    CHECK(contains(refused.errors, "kinetome reindex"));
    CHECK_FALSE(fs::exists(folder / "nothing"));
    CHECK(run_program({"bundles", (folder / "nothing").string(), "--rho", "2"}).exit_code != 0);
    CHECK_FALSE(fs::exists(folder / "nothing"));
}

TEST_CASE("a bundle finds motion of its label that it does not hold", "[bundles]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 24000, 2);
    const StoreOnDisk store(folder / "store");
    require_program(reindex(corpus, store.path(),
                            {"--only", stages_of_bundles + ",pose_hierarchy,signatures"}));
    fs::copy_file(corpus / "cycles.csv", store.path() / "labels.csv");
    struct Piece {
        std::string clip;
        int64_t first, end;
        bool shares(const Piece& other) const {
            const int64_t both = std::min(end, other.end) - std::max(first, other.first);
            return clip == other.clip &&
                   10 * both > 3 * std::min(end - first, other.end - other.first);
        }
    };
    std::vector<Piece> walks;
    for (const auto& row : rows_of(text_of(corpus / "truth.csv"))) {
        if (row[3] == "walk") walks.push_back({row[0], std::stoll(row[1]), std::stoll(row[2])});
    }
    // The largest bundle of walking.
    std::string bundle;
    for (const auto& row :
         rows_of(require_program({"bundles", store.name(), "--format", "csv"}).output)) {
        if (bundle.empty() && row[1] == "walk") bundle = row[0];
    }
    REQUIRE(!bundle.empty());
    std::vector<Piece> members;
    for (const auto& row : rows_of(require_program({"export", store.name(), "bundles"}).output)) {
        if (row[0] == bundle) members.push_back({row[1], std::stoll(row[2]), std::stoll(row[3])});
    }
    REQUIRE(members.size() > 1);

    for (const bool rerank : {false, true}) {
        std::vector<std::string> words = {"query", store.name(), "--bundle", bundle, "-k", "8"};
        if (rerank) words.push_back("--rerank");
        const std::string table = require_program(words).output;
        CHECK(lines_of(table).front() == "rank,clip,first,end,distance");
        const auto rows = rows_of(table);
        REQUIRE(rows.size() == 8);
        int64_t walking = 0;
        double last = 0;
        for (size_t i = 0; i < rows.size(); ++i) {
            const Piece found{rows[i][1], std::stoll(rows[i][2]), std::stoll(rows[i][3])};
            CHECK(rows[i][0] == std::to_string(i + 1));
            CHECK(std::stod(rows[i][4]) >= last);
            last = std::stod(rows[i][4]);
            for (const Piece& member : members) CHECK_FALSE(found.shares(member));
            walking += std::ranges::any_of(walks, [&](const Piece& walk) {
                return walk.clip == found.clip &&
                       std::min(walk.end, found.end) - std::max(walk.first, found.first) >
                           (found.end - found.first) / 2;
            });
        }
        CHECK(walking >= 7);
    }
    const auto refused = [&](std::vector<std::string> more) {
        std::vector<std::string> words = {"query", store.name()};
        words.insert(words.end(), more.begin(), more.end());
        return require_program(words, usage).errors;
    };
    CHECK(contains(refused({"--bundle", "swimming"}), "no bundle has this label or number"));
    CHECK(contains(refused({"--bundle", bundle, "--clip", "01_01"}), "give one of"));
    CHECK(contains(refused({"--bundle", bundle, "--frames", "0:9"}), "as a whole"));
}

TEST_CASE("walks are refused between bundles that no path joins, and between no others",
          "[bundles]") {
    const TemporaryFolder folder;
    generate_corpus(folder / "takes", 16000, 2);
    const StoreOnDisk store(folder / "store");
    require_program(reindex(folder / "takes", store.path(), {"--only", stages_of_bundles}));
    std::map<std::string, std::set<std::string>> reached;  // by bundle, at first in one step
    for (const auto& row :
         rows_of(require_program({"export", store.name(), "bundle-graph"}).output)) {
        reached[row[2]].insert(row[3]);
        reached.try_emplace(row[3]);
    }
    const auto pairs = [&] {
        size_t count = 0;
        for (const auto& [from, all] : reached) count += all.size();
        return count;
    };
    for (size_t before = 0; before != pairs();) {
        before = pairs();
        for (auto& [from, all] : reached) {
            for (const std::string& next : std::set<std::string>(all)) {
                all.insert(reached[next].begin(), reached[next].end());
            }
        }
    }
    constexpr int tried = 4;
    int ways = 0, none = 0;
    for (const auto& [from, all] : reached) {
        for (const auto& [to, unused] : reached) {
            int& count = all.count(to) ? ways : none;
            if (from == to || count == tried) continue;
            ++count;
            CAPTURE(from, to);
            const CommandResult walk =
                run_program({"walk", store.name(), "--graph", "bundles", "--from", from, "--to", to,
                             "--seconds", "5", "-o", (folder / "w.bvh").string()});
            if (all.count(to)) {
                CHECK(walk.exit_code == 0);
                continue;
            }
            CHECK(walk.exit_code == usage);
            CHECK(contains(walk.errors, "no path from '" + from + "' to '" + to + "'"));
        }
    }
    CHECK(ways == tried);
    CHECK(none == tried);
}

TEST_CASE("bundles are scored as a segmentation of the takes that they cut", "[bundles]") {
    const TemporaryFolder folder;
    generate_corpus(folder / "takes", 6000, 1);
    const StoreOnDisk store(folder / "store");
    require_program(reindex(folder / "takes", store.path(), {"--only", stages_of_bundles}));
    std::map<std::string, int64_t> frames_of;
    for (const auto& row : rows_of(require_program({"export", store.name(), "clips"}).output))
        frames_of[row[0]] = std::stoll(row[4]);
    // The same as a table: what no bundle of several members holds is a transition.
    std::map<std::string, std::vector<std::vector<std::string>>> members_of;
    for (const auto& row : rows_of(require_program({"export", store.name(), "bundles"}).output)) {
        if (row[4] == "0") members_of[row[1]].push_back(row);
    }
    std::string table = "clip,first,end,kind,activity_cluster\n";
    for (const auto& [clip, frames] : frames_of) {
        int64_t end = 0;
        const auto add_transition = [&](int64_t first) {
            if (end == first) return;
            table +=
                clip + "," + std::to_string(end) + "," + std::to_string(first) + ",transition,\n";
        };
        for (const auto& row : members_of[clip]) {
            add_transition(std::stoll(row[2]));
            table += clip + "," + row[2] + "," + row[3] + ",activity," + row[0] + "\n";
            end = std::stoll(row[3]);
        }
        add_transition(frames);
    }
    const std::string segments = folder.write("segments.csv", table).string();
    const auto evaluate = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {"evaluate", store.name()});
        words.insert(words.end(), {"--truth", (folder / "takes/truth.csv").string()});
        return require_program(words).output;
    };
    const std::string score = evaluate({"--what", "bundle-segments"});
    CHECK(score == evaluate({"--segments", segments}));
    CHECK(contains(score, "a cut every second"));
    evaluate({"--what", "bundle-segments", "--svg", (folder / "pictures").string()});
    CHECK(contains(text_of(folder / "pictures/01_01.svg"), ">bundles</text>"));
}

TEST_CASE("where no motion recurs there are no bundles to list, and none to walk through",
          "[bundles]") {
    const SmallCorpus corpus;
    corpus.add_skeleton("01/01.asf");
    corpus.add("01/01_01.amc", first_frames(corpus.performer().amc, 3));
    const std::string store = corpus.store().string();
    require_program(reindex(corpus.path(), corpus.store(), {"--only", stages_of_bundles}));
    CHECK(require_program({"bundles", store, "--format", "csv"}).output ==
          "bundle,label,height,width,volume,takes\n");
    CHECK(contains(require_program({"bundles", store}).output, "frames in bundles              0"));
    const CommandResult walk =
        require_program({"walk", store, "--graph", "bundles", "-o", "w.bvh"}, usage);
    CHECK(contains(walk.errors, "the store has no bundles: nothing in its takes recurs"));
}
