// What `walk` and the export of its graph promise.
#include <cmath>
#include <map>
#include <numeric>
#include <regex>
#include <set>
#include <sstream>

#include "kinetome/store/json_text.h"
#include "program.h"
#include "store_on_disk.h"
#include "support/temporary_folder.h"
#include "support/test_corpus.h"
#include "takes.h"

namespace {

constexpr int usage = 64, bad_data = 65, cannot_create = 73;

/// A store of generated takes whose cycles are its labels.
struct LabelledStore {
    TemporaryFolder folder;
    std::string path = (folder / "store").string();
    LabelledStore() {
        generate_corpus(folder / "takes", 24000, 2);
        require_program(reindex(folder / "takes", path,
                                {"--only",
                                 "frames,features,pose_clusters,motion_strings,bundles,"
                                 "bundle_graph,neighbors,segments,primitives"}));
        fs::copy_file(folder / "takes" / "cycles.csv", fs::path(path) / "labels.csv");
    }
    std::string output(const std::string& name) const { return (folder / name).string(); }
};

int64_t lines_after(const std::string& text, const std::string& beginning) {
    const auto lines = lines_of(text);
    const auto found = std::find_if(lines.begin(), lines.end(), [&](const std::string& line) {
        return line.starts_with(beginning);
    });
    return lines.end() - found - 1;
}

}  // namespace

TEST_CASE("a walk is written as BVH and as AMC with its skeleton, the same for the same seed",
          "[walk]") {
    const LabelledStore store;
    const auto walk = [&](const std::string& output, std::vector<std::string> more = {}) {
        std::vector<std::string> words = {"walk",   store.path, "--seconds", "10",
                                          "--seed", "3",        "-o",        store.output(output)};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    const CommandResult first = require_program(walk("first.bvh", {"--graph", "primitives"}));
    CHECK(contains(first.output, "1200 frames at 120 a second"));
    CHECK(contains(first.output, "foot slide"));
    const std::string bvh = text_of(store.output("first.bvh"));
    CHECK(contains(bvh, "Frames: 1200\n"));
    CHECK(lines_after(bvh, "Frame Time: ") == 1200);
    require_program(walk("again.bvh", {"--threads", "1"}));
    CHECK(text_of(store.output("again.bvh")) == bvh);

    // What is written is a take like any other.
    require_program(walk("takes/walk.amc"));
    require_program({"ingest", store.output("takes"), "--store", store.output("other")});
    require_program({"publish", store.output("other")});
    const auto clips = lines_of(require_program({"export", store.output("other"), "clips"}).output);
    CHECK(std::count_if(clips.begin(), clips.end(), [](const std::string& line) {
              return line.starts_with("walk,") && contains(line, ",1200,indexed,");
          }) == 1);

    CHECK(contains(require_program(walk("takes/01/01.amc"), cannot_create).errors,
                   "01.asf is the skeleton of something else"));
    CHECK(contains(require_program(walk("walk.txt"), usage).errors, ".bvh or .amc"));
    CHECK(contains(require_program(walk("w.bvh", {"--graph", "letters"}), usage).errors,
                   "expected primitives or bundles"));
    CHECK(contains(require_program(walk("w.bvh", {"--from", "swimming"}), usage).errors,
                   "no primitive has this label or cluster"));
    CHECK(contains(require_program(walk("w.bvh", {"--body", "nobody"}), usage).errors,
                   "no clip 'nobody' is indexed"));
    CHECK_FALSE(fs::exists(store.output("w.bvh")));

    const std::string dot =
        require_program({"export", store.path, "primitive-graph", "--format", "dot"}).output;
    CHECK(dot.starts_with("digraph primitives {"));
    const auto rows = lines_of(require_program({"export", store.path, "primitive-graph"}).output);
    CHECK(rows.front().starts_with("from_node,to_node,from_cluster,to_cluster,from_label,"));
    CHECK(rows.size() > 10);
    CHECK(contains(
        require_program({"export", store.path, "letters", "--format", "dot"}, usage).errors,
        "expected csv or json"));
}

TEST_CASE("labels of some takes spread to others, and lead walks from then on", "[label]") {
    const LabelledStore store;
    // Of every other take nobody has told the labels.
    std::string some;
    std::set<std::string> takes;
    const auto rows = lines_of(text_of(fs::path(store.path) / "labels.csv"));
    for (const std::string& row : rows) {
        takes.insert(row.substr(0, row.find(',')));
        if (takes.size() % 2 == 1) some += row + "\n";
    }
    fs::remove(fs::path(store.path) / "labels.csv");
    store.folder.write("some.csv", some);
    const auto labelled = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"export", store.path, "primitives"};
        words.insert(words.end(), more.begin(), more.end());
        const auto lines = lines_of(require_program(words).output);
        return std::count_if(lines.begin() + 1, lines.end(),
                             [](const std::string& line) { return !line.ends_with(','); });
    };
    require_program({"label", store.path, "--from", store.output("some.csv"), "-o",
                     store.output("labelled.csv")});
    const std::string table = text_of(store.output("labelled.csv"));
    CHECK(table.starts_with("clip,first,end,label,origin,cost,source_clip,source_first"));
    CHECK(contains(table, ",known,"));
    CHECK(contains(table, ",transferred,"));

    const auto known = labelled({"--labels", store.output("some.csv")});
    CHECK(labelled({}) == 0);
    CHECK(known > 0);
    CHECK(labelled({"--labels", store.output("labelled.csv")}) > known);
    fs::copy_file(store.output("labelled.csv"), fs::path(store.path) / "labels.csv");
    CHECK(labelled({}) > known);
    fs::remove(fs::path(store.path) / "labels.csv");

    const std::string label = rows.back().substr(rows.back().rfind(',') + 1);
    const std::vector<std::string> walk{"walk",   store.path, "--seconds", "2",
                                        "--from", label,      "-o",        store.output("w.bvh")};
    CHECK(contains(require_program(walk, usage).errors, "no primitive has this label"));
    auto with_labels = walk;
    with_labels.insert(with_labels.end(), {"--labels", store.output("labelled.csv")});
    CHECK(contains(require_program(with_labels).output, "path          " + label));

    store.folder.write("bad.csv", "clip,first,end\n");
    CHECK(contains(
        require_program({"export", store.path, "primitives", "--labels", store.output("bad.csv")},
                        bad_data)
            .errors,
        "bad.csv:1: expected a header line that begins with clip,first,end,label"));
}

TEST_CASE("a walk leads through bundles, and bundles are exported and evaluated", "[walk]") {
    const LabelledStore store;
    const auto walk = [&](std::vector<std::string> more) {
        std::vector<std::string> words = {"walk",    store.path,           "--graph",
                                          "bundles", "--seconds",          "10",
                                          "-o",      store.output("b.bvh")};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    const CommandResult walked = require_program(walk({}));
    CHECK(contains(walked.output, "1200 frames at 120 a second"));
    CHECK(contains(walked.output, "foot slide"));
    CHECK(contains(walked.output, "bundle "));
    const std::string bvh = text_of(store.output("b.bvh"));
    require_program(walk({"--threads", "1"}));
    CHECK(text_of(store.output("b.bvh")) == bvh);
    CHECK(contains(require_program(walk({"--from", "swimming"}), usage).errors,
                   "no member has this label or bundle"));

    const auto rows = lines_of(require_program({"export", store.path, "bundles"}).output);
    CHECK(rows.front() == "bundle,clip,first,end,degenerate");
    CHECK(rows.size() > 20);
    const std::string dot =
        require_program({"export", store.path, "bundle-graph", "--format", "dot"}).output;
    CHECK(dot.starts_with("digraph bundles {"));
    CHECK(contains(dot, "fixedsize=true, width="));
    const std::string picture =
        require_program({"export", store.path, "bundle-graph", "--format", "svg"}).output;
    CHECK(contains(picture, "<title id=\"title\">Graph of bundles</title>"));

    // The numbers of bundles are the same wherever they are told.
    const auto list = lines_of(require_program({"bundles", store.path, "--format", "csv"}).output);
    CHECK(list.front() == "bundle,label,height,width,volume,takes");
    REQUIRE(list.size() > 10);
    int64_t exported = 0, listed = 0;
    const std::string largest = list[1].substr(0, list[1].find(','));
    for (const std::string& row : rows) exported += row.starts_with(largest + ",");
    std::istringstream first(list[1].substr(list[1].find(',', largest.size() + 1) + 1));
    first >> listed;
    CHECK(listed == exported);
    CHECK(contains(require_program(walk({"--from", largest})).output, "bundle " + largest));
    const std::string told = require_program({"bundles", store.path}).output;
    CHECK(contains(told, "dangling frames"));
    CHECK(contains(told, "bundles.h5"));

    // A blend of one motion is that motion; of several it has their mean length.
    const auto blend_of = [&](const std::string& name, const std::string& weights) {
        return std::vector<std::string>{
            "walk", store.path,  "--graph", "bundles", "--blend",
            name,   "--weights", weights,   "-o",      store.output("b.bvh")};
    };
    std::vector<int64_t> lengths;
    for (const std::string& row : rows) {
        if (!row.starts_with(largest + ",")) continue;
        std::istringstream cells(row.substr(row.find(',', largest.size() + 1) + 1));
        int64_t first_frame = 0, end_frame = 0;
        char comma = 0;
        cells >> first_frame >> comma >> end_frame;
        lengths.push_back(end_frame - first_frame);
    }
    REQUIRE(lengths.size() > 2);
    const auto blend = [&](std::string weights) {
        for (size_t given = 2; given < lengths.size(); ++given) weights += ",0";
        return blend_of(largest, weights);
    };
    CHECK(contains(require_program(walk({"--blend", largest}), usage).errors, "--seconds"));
    CHECK(contains(require_program(blend("1,0")).output,
                   "motion        " + std::to_string(lengths[0]) + " frames"));
    const auto mean = std::llround(double(lengths[0] + 2 * lengths[1]) / 3);
    CHECK(contains(require_program(blend("1,2")).output,
                   "motion        " + std::to_string(mean) + " frames"));
    CHECK(contains(require_program(blend("0,0"), usage).errors, "one of them must be above 0"));
    CHECK(contains(require_program(blend_of(largest, "1,1"), usage).errors, "expected one each"));
    CHECK(contains(require_program(blend("1,-1"), usage).errors, "is no weight"));
    CHECK(contains(require_program(blend_of("swimming", "1"), usage).errors,
                   "no bundle has this label or number; `kinetome bundles"));

    const auto score =
        lines_of(require_program({"evaluate", store.path, "--what", "bundles", "--truth",
                                  store.output("takes/truth.csv"), "--format", "csv"})
                     .output);
    CHECK(score.front() ==
          "bundles,purity,shuffled,chance,coverage,mean_height,median_width,frames,kept_frames,"
          "ratio,rms_mm,control_rms_mm,file_bytes,text_bytes");
    REQUIRE(score.size() == 2);
    // Of each bundle as many frames are kept as one member has.
    std::vector<double> numbers;
    std::istringstream cells(score[1]);
    for (std::string cell; std::getline(cells, cell, ',');) numbers.push_back(std::stod(cell));
    std::map<std::string, std::vector<int64_t>> lengths_of;
    for (size_t i = 1; i < rows.size(); ++i) {
        std::vector<std::string> row;
        std::istringstream text(rows[i]);
        for (std::string cell; std::getline(text, cell, ',');) row.push_back(cell);
        if (row.at(4) == "0") lengths_of[row[0]].push_back(std::stoll(row[3]) - std::stoll(row[2]));
    }
    int64_t least = 24000, most = 24000;
    for (const auto& [bundle, all] : lengths_of) {
        const int64_t sum = std::accumulate(all.begin(), all.end(), int64_t{0});
        least -= sum - std::ranges::min(all);
        most -= sum - std::ranges::max(all);
    }
    CHECK(numbers.at(7) == 24000);
    CHECK(numbers.at(8) >= double(least));
    CHECK(numbers.at(8) <= double(most));
    CHECK(numbers.at(9) == Approx(numbers.at(7) / numbers.at(8)));
    CHECK(numbers.at(10) > 0);
    CHECK(numbers.at(10) < numbers.at(11));
    CHECK(numbers.at(13) ==
          double(require_program({"export", store.path, "bundles"}).output.size()));
}

namespace {

/// The two numbers of a line of what walk prints: of the walk, and of the takes.
std::pair<double, double> measured(const std::string& output, const std::string& line) {
    const std::string number = "([0-9.]+)";
    const std::regex pattern(line + " +" + number + "[^0-9]*" + number + "\\)");
    std::smatch found;
    REQUIRE(std::regex_search(output, found, pattern));
    return {std::stod(found[1]), std::stod(found[2])};
}

using Words = std::vector<std::string>;

/// No pose, joint or jolt above what the takes have, wherever the walk leads. What it prints.
std::string check_walk(const Words& words) {
    std::string told = require_program(words).output;
    CAPTURE(words, told);
    for (const char* const line : {"pose step", "fastest joint"}) {
        const auto [walked, in_takes] = measured(told, line);
        CHECK(walked <= in_takes);
    }
    // The takes' own frames are played elsewhere on the floor, where floats round otherwise.
    const auto [jolt, jolt_in_takes] = measured(told, "hardest jolt");
    CHECK(jolt <= jolt_in_takes * (1 + 1e-4));
    CHECK(measured(told, "foot slide").second > 0);
    return told;
}

void check_quality(const std::string& store, const std::string& graph, const std::string& output) {
    for (const char* const registration : {"warp", "even"}) {
        for (const char* const seed : {"1", "2", "3"}) {
            const Words words{"walk",   store, "--graph",        graph,        "--seconds", "20",
                              "--seed", seed,  "--registration", registration, "-o",        output};
            const auto [slide, in_takes] = measured(check_walk(words), "foot slide");
            CAPTURE(words);
            CHECK(slide <= 1.5 * in_takes);
        }
    }
}

/// Bundles that links join, by number, each pair once.
std::vector<std::pair<std::string, std::string>> linked_bundles(const std::string& store) {
    const kinetome::Json graph = kinetome::Json::parse(
        require_program({"export", store, "bundle-graph", "--format", "json"}).output);
    const auto bundle = [&](const kinetome::Json& node) {
        return std::to_string(graph["nodes"][node.get<size_t>()]["bundle"].get<int>());
    };
    std::vector<std::pair<std::string, std::string>> pairs;
    for (const kinetome::Json& link : graph["links"])
        pairs.emplace_back(bundle(link["first"]), bundle(link["second"]));
    return pairs;
}

}  // namespace

TEST_CASE("in walks poses and joints are no faster than in the takes, and feet slide hardly more",
          "[walk]") {
    const LabelledStore store;
    check_quality(store.path, "bundles", store.output("w.bvh"));
    check_quality(store.path, "primitives", store.output("w.bvh"));
    CHECK(contains(
        require_program({"walk", store.path, "--registration", "odd", "-o", store.output("w.bvh")},
                        usage)
            .errors,
        "expected warp or even"));
}

TEST_CASE("the same holds of walks through the bundles of real takes", "[walk][corpus]") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    const TemporaryFolder folder;
    fs::create_directory(folder / "takes");
    for (const char* const file : {"14/14_14.amc", "14/14.asf", "13/13_29.amc", "13/13.asf"}) {
        fs::copy_file(*corpus / "cmu" / file, folder / "takes" / fs::path(file).filename());
    }
    const std::string store = (folder / "store").string();
    require_program({"reindex", (folder / "takes").string(), "--store", store, "--only",
                     "frames,features,pose_clusters,motion_strings,bundles,bundle_graph"});
    check_quality(store, "bundles", (folder / "w.bvh").string());
}

TEST_CASE("a walk leads from the bundles of one body to those of another", "[walk]") {
    const TemporaryFolder folder;
    const std::string store = (folder / "store").string(), output = (folder / "w.bvh").string();
    require_program({"generate", "--frames", "16000", "--seed", "5", "--subjects", "2", "-o",
                     (folder / "takes").string()});
    require_program(reindex(folder / "takes", store,
                            {"--partition", "subject", "--only",
                             "frames,features,pose_clusters,motion_strings,bundles,"
                             "bundle_graph"}));
    const std::string dot =
        require_program({"export", store, "bundle-graph", "--format", "dot"}).output;
    CHECK(contains(dot, "style=dashed"));

    std::map<std::string, std::string> subject_of;  // of bundles
    for (const std::string& row : lines_of(require_program({"export", store, "bundles"}).output)) {
        const size_t comma = row.find(',');
        subject_of[row.substr(0, comma)] = row.substr(comma + 1, 2);
    }
    const auto links = linked_bundles(store);
    REQUIRE(!links.empty());
    for (const auto& [one, other] : links) CHECK(subject_of.at(one) != subject_of.at(other));
    const auto& [from, to] = links.front();
    const CommandResult walked = require_program({"walk", store, "--graph", "bundles", "--seconds",
                                                  "1", "--from", from, "--to", to, "-o", output});
    CHECK(contains(walked.output, "bundle " + from));
    CHECK(contains(walked.output, "bundle " + to));
    CHECK(contains(walked.output, "on the body of " + subject_of.at(from)));
    check_quality(store, "bundles", output);
    for (size_t i = 0; i < links.size(); i += links.size() / 6 + 1) {
        check_walk({"walk", store, "--graph", "bundles", "--seconds", "1", "--from", links[i].first,
                    "--to", links[i].second, "-o", output});
    }
}

TEST_CASE("no joint is faster where a walk leads from one real body to another", "[walk][corpus]") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    const TemporaryFolder folder;
    const std::string store = (folder / "store").string(), output = (folder / "w.bvh").string();
    for (const char* const take : {"13/13_29", "13/13_30", "14/14_04", "14/14_14"}) {
        const fs::path file = fs::path(std::string(take) + ".amc");
        const fs::path home = file.parent_path(), asf = home / (home.string() + ".asf");
        fs::create_directories(folder / "takes" / home);
        fs::copy_file(*corpus / "cmu" / file, folder / "takes" / file);
        fs::copy_file(*corpus / "cmu" / asf, folder / "takes" / asf,
                      fs::copy_options::skip_existing);
    }
    require_program({"reindex", (folder / "takes").string(), "--store", store, "--partition",
                     "subject", "--only",
                     "frames,features,pose_clusters,motion_strings,bundles,bundle_graph"});
    const auto links = linked_bundles(store);
    REQUIRE(links.size() > 4);
    for (size_t i = 0; i < links.size(); i += links.size() / 6 + 1) {
        for (const char* const registration : {"warp", "even"}) {
            check_walk({"walk", store, "--graph", "bundles", "--seconds", "1", "--registration",
                        registration, "--from", links[i].first, "--to", links[i].second, "-o",
                        output});
        }
    }
}
