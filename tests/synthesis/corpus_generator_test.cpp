#include "kinetome/synthesis/corpus_generator.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <map>
#include <numeric>
#include <string>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/formats/asf_amc.h"
#include "kinetome/synthesis/take.h"
#include "support/temporary_folder.h"

using namespace kinetome;

namespace {

namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;

Files files_of(const fs::path& folder) {
    Files files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
    return files;
}

Files generated(const GenerateOptions& options, int threads) {
    const TemporaryFolder folder;
    generate_corpus(options, folder / "takes", threads);
    return files_of(folder / "takes");
}

Clip parsed(const Files& files, const std::string& subject, const std::string& name) {
    const std::string asf = subject + "/" + subject + ".asf", amc = subject + "/" + name + ".amc";
    return parse_amc(files.at(amc), amc,
                     std::make_shared<const Skeleton>(parse_asf(files.at(asf), asf)));
}

/// Every take of the files, as the library's own parser reads it.
std::map<std::string, Clip> parsed(const Files& files) {
    std::map<std::string, Clip> clips;
    for (const auto& [path, text] : files) {
        if (!path.ends_with(".amc")) continue;
        const std::string subject = fs::path(path).parent_path().string();
        const std::string name = fs::path(path).stem().string();
        clips[name] = parsed(files, subject, name);
    }
    return clips;
}

}  // namespace

TEST_CASE("a seed gives the same bytes for 1, 2 and 7 threads") {
    const GenerateOptions options{.frames = 12'000, .seed = 5};
    const Files one = generated(options, 1);
    CHECK(one.size() > 8);
    CHECK(generated(options, 2) == one);
    CHECK(generated(options, 7) == one);
}

TEST_CASE("another seed gives other motion") {
    const Files one = generated({.frames = 1200, .seed = 1}, 2);
    const Files other = generated({.frames = 1200, .seed = 2}, 2);
    CHECK(one.at("01/01_01.amc") != other.at("01/01_01.amc"));
    CHECK(one.at("01/01.asf") != other.at("01/01.asf"));
}

TEST_CASE("the takes have exactly the frames asked for, and the labels tile each of them") {
    const Files files = generated({.frames = 20'000, .seed = 3, .subjects = 4}, 2);
    const std::map<std::string, Clip> clips = parsed(files);
    int64_t frames = 0;
    for (const auto& [name, clip] : clips) frames += clip.frames();
    CHECK(frames == 20'000);

    std::map<std::string, int64_t> labelled;
    for (const TruthRow& row : parse_truth_csv(files.at("truth.csv"), "truth.csv")) {
        CHECK(row.first == labelled[row.clip]);
        CHECK(row.end > row.first);
        CHECK(row.end_lo <= row.end);
        CHECK(row.end_hi >= row.end);
        labelled[row.clip] = row.end;
    }
    CHECK(labelled.size() == clips.size());
    for (const auto& [name, clip] : clips) CHECK(labelled[name] == clip.frames());
    CHECK(parse_cycles_csv(files.at("cycles.csv"), "cycles.csv").size() > 20);
    CHECK(files.count("04/04.asf") == 1);
    CHECK(files.count("05/05.asf") == 0);
}

TEST_CASE("what is written is what was performed") {
    constexpr uint64_t seed = 9;
    const Files files = generated({.frames = 900, .seed = seed}, 1);
    const Clip read = parsed(files, "01", "01_01");
    const Clip made = perform(plan_take(0, 900, 1, 1, seed), make_subject(1, seed), seed);
    REQUIRE(read.motion.rows() == made.motion.rows());
    CHECK((read.motion - made.motion).cwiseAbs().maxCoeff() < 1e-4F);
    CHECK(read.skeleton->class_name() == made.skeleton->class_name());
}

TEST_CASE("a single frame is a corpus, none is not") {
    CHECK(parsed(generated({.frames = 1}, 1)).at("01_01").frames() == 1);
    CHECK_THROWS_AS(generated({.frames = 0}, 1), UsageError);
    CHECK_THROWS_AS(generated({.frames = -5}, 1), UsageError);
}

TEST_CASE("a BVH corpus has one file a take and no skeleton files") {
    const Files files = generated({.frames = 1500, .format = MotionFormat::bvh}, 2);
    CHECK(files.size() == 3);
    CHECK(files.at("01/01_01.bvh").starts_with("HIERARCHY"));
}

TEST_CASE("a folder with something in it is left alone") {
    const TemporaryFolder folder;
    folder.write("takes/precious.txt", "mine");
    CHECK_THROWS_AS(generate_corpus({.frames = 700}, folder / "takes", 1), UsageError);
    CHECK(files_of(folder.path()).size() == 1);
    fs::remove(folder / "takes/precious.txt");
    CHECK_NOTHROW(generate_corpus({.frames = 700}, folder / "takes/", 1));
    CHECK(fs::exists(folder / "takes/truth.csv"));
}

TEST_CASE("a stopped run publishes nothing, and the same command goes on from there") {
    const TemporaryFolder folder;
    std::atomic<bool> stop{false};
    const auto after_first = [&](int64_t) { stop = true; };
    CHECK_THROWS_AS(
        generate_corpus({.frames = 30'000}, folder / "takes", 2, after_first, StopToken(stop)),
        Interrupted);
    CHECK_FALSE(fs::exists(folder / "takes"));
    generate_corpus({.frames = 3000}, folder / "takes", 2);
    CHECK(files_of(folder / "takes") == generated({.frames = 3000}, 1));
    CHECK_FALSE(fs::exists(folder / "takes.incomplete"));
}

TEST_CASE("a corpus that cannot be written says so") {
    CHECK_THROWS_AS(generate_corpus({.frames = 700}, "/dev/null/takes", 1), CreateError);
}

TEST_CASE("progress adds up to the frames asked for") {
    const TemporaryFolder folder;
    std::atomic<int64_t> frames{0};
    const GenerateSummary summary = generate_corpus({.frames = 9000}, folder / "takes", 3,
                                                    [&](int64_t more) { frames += more; });
    CHECK(frames == 9000);
    CHECK(summary.frames == 9000);
    CHECK(summary.takes == static_cast<int64_t>(parsed(files_of(folder / "takes")).size()));
}

TEST_CASE("varied takes carry their labels along, as many frames as asked for") {
    const TemporaryFolder folder;
    generate_corpus({.frames = 4000, .seed = 2, .subjects = 2}, folder / "source", 2);
    const GenerateOptions options{.frames = 15'000, .seed = 6, .from = folder / "source"};
    const Files files = generated(options, 2);
    CHECK(generated(options, 7) == files);

    const std::map<std::string, Clip> clips = parsed(files);
    int64_t frames = 0;
    for (const auto& [name, clip] : clips) frames += clip.frames();
    CHECK(frames == 15'000);
    std::map<std::string, int64_t> labelled;
    for (const TruthRow& row : parse_truth_csv(files.at("truth.csv"), "truth.csv")) {
        CHECK(row.first == labelled[row.clip]);
        labelled[row.clip] = row.end;
    }
    for (const auto& [name, clip] : clips) CHECK(labelled[name] == clip.frames());
    CHECK(parse_cycles_csv(files.at("cycles.csv"), "cycles.csv").size() > 20);
}

TEST_CASE("a corpus without takes cannot be varied") {
    const TemporaryFolder folder;
    folder.write("empty/readme.txt", "no takes");
    folder.write("alone/01_01.amc", ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\n");
    for (const char* from : {"empty", "alone", "missing"}) {
        GenerateOptions options{.frames = 700, .from = folder / from};
        CHECK_THROWS_AS(generate_corpus(options, folder / "takes", 1), InputError);
    }
    CHECK_FALSE(fs::exists(folder / "takes"));
}
