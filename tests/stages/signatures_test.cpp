#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/features/markers.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/stages/motion_compression.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/reindex.h"
#include "kinetome/stages/signature_file.h"
#include "kinetome/stages/signature_query.h"
#include "kinetome/stages/stored_clips.h"
#include "kinetome/synthesis/corpus_generator.h"
#include "support/temporary_folder.h"

using namespace kinetome;

namespace {

/// A store with signatures, made once.
struct SignedStore {
    TemporaryFolder folder;
    SignedStore() {
        generate_corpus({.frames = 6000, .subjects = 2}, folder / "takes", 2);
        ReindexRequest request;
        request.corpus = folder / "takes";
        request.store = folder / "store";
        request.resources.threads = 2;
        request.resources.memory_bytes = uint64_t{1} << 30;
        request.only = {"frames", "features", "pose_hierarchy", "signatures"};
        reindex(request, Log(), {});
    }
};

const OpenStore& store() {
    static const SignedStore made;
    static const OpenStore opened(made.folder / "store");
    return opened;
}

const std::filesystem::path& takes() {
    static const std::filesystem::path folder = store().generation.catalog().corpus;
    return folder;
}

const CatalogClip& longest_clip() {
    return *std::ranges::max_element(store().generation.catalog().clips, {}, &CatalogClip::frames);
}

struct Answer {
    std::string clip;
    RowRange frames;
    double distance;
};

std::vector<Answer> answers(const SignatureQuery& query) {
    std::vector<Answer> found;
    for (const auto& row : query_table(store().generation, query, 2).rows) {
        CHECK(std::get<int64_t>(row[0]) == std::ssize(found) + 1);
        found.push_back({std::get<std::string>(row[1]),
                         {std::get<int64_t>(row[2]), std::get<int64_t>(row[3])},
                         std::get<double>(row[4])});
    }
    return found;
}

SignatureQuery part_of_longest() {
    SignatureQuery query;
    query.clip = longest_clip().name;
    query.frames = RowRange{80, 320};
    return query;
}

/// The file with all clips, compressed once.
struct Compressed {
    TemporaryFolder folder;
    std::filesystem::path path = folder / "all.motion";
    CompressedMotion made;
    Compressed() {
        std::vector<std::string> clips;
        for (const auto& clip : store().generation.catalog().clips) clips.push_back(clip.name);
        made = compress_clips(store().generation, clips, path);
    }
};

const Compressed& compressed() {
    static const Compressed all;
    return all;
}

}  // namespace

TEST_CASE("signatures cover every frame of every clip, no leaf following itself") {
    std::map<std::string, std::pair<int64_t, int64_t>> last;  // end and leaf, by clip
    for (const auto& row : signature_table(store().generation).rows) {
        const auto known = last.find(std::get<std::string>(row[0]));
        CHECK(std::get<int64_t>(row[1]) == (known == last.end() ? 0 : known->second.first));
        if (known != last.end()) CHECK(std::get<int64_t>(row[3]) != known->second.second);
        last[std::get<std::string>(row[0])] = {std::get<int64_t>(row[2]),
                                               std::get<int64_t>(row[3])};
    }
    for (const CatalogClip& clip : store().generation.catalog().clips) {
        CHECK(last.at(clip.name).first == clip.frames);
    }
}

TEST_CASE("a part of a clip finds itself first, by every rule") {
    SignatureQuery query = part_of_longest();
    for (const MatchRule rule : {MatchRule::repeats, MatchRule::edit}) {
        query.search.match.rule = rule;
        const Answer first = answers(query).at(0);
        CHECK(first.clip == query.clip);
        CHECK(is_same_place(first.frames, *query.frames, 0.8));
    }
    query.search.match.tolerance = 0;
    CHECK(answers(query).at(0).frames == *query.frames);
}

TEST_CASE("any part of any clip finds itself to the frame, and is not off") {
    for (const CatalogClip& clip : store().generation.catalog().clips) {
        for (const int64_t first : {0, 37, 222}) {
            SignatureQuery query;
            query.clip = clip.name;
            query.frames = RowRange{first, std::min(first + 201, clip.frames)};
            query.answers = 1;
            const Answer found = answers(query).at(0);
            INFO(clip.name << " from frame " << first << ", found at " << found.frames.first << ":"
                           << found.frames.end);
            CHECK(found.clip == query.clip);
            CHECK(found.frames == *query.frames);
            CHECK(found.distance < 3);
        }
    }
    SignatureQuery query = part_of_longest();
    query.frames = RowRange{83, 324};
    query.rerank = true;
    const Answer first = answers(query).at(0);
    CHECK(first.clip == query.clip);
    CHECK(first.frames == *query.frames);
    CHECK(first.distance == Approx(0).margin(1e-3));
}

TEST_CASE("signatures of an earlier version are refused, with what to do about it") {
    const TemporaryFolder folder;
    ArtifactWriter writer(folder / "signatures.h5", {.stage = "signatures"});
    const std::vector<double> rate{120};
    writer.write<double>({.path = "/class/pose_rate", .type = ElementType::float64}, rate);
    const ArtifactReader file(folder / "signatures.h5", writer.close().hash);
    CHECK_THROWS_AS(read_signatures(file, "/class"), StoreError);
    CHECK_THROWS_WITH(read_signatures(file, "/class"), Catch::Contains("kinetome reindex"));
    CHECK_THROWS_WITH(read_signatures(file, "/other"), Catch::Contains("no signatures of class"));
}

TEST_CASE("a take outside the store is looked for as the clip it is") {
    SignatureQuery query = part_of_longest();
    const auto by_clip = answers(query);
    query.file = takes() / longest_clip().source;
    query.clip.clear();
    const auto by_file = answers(query);
    REQUIRE(by_file.size() == by_clip.size());
    for (size_t i = 0; i < by_file.size(); ++i) {
        CHECK(by_file[i].clip == by_clip[i].clip);
        CHECK(by_file[i].frames == by_clip[i].frames);
    }
}

TEST_CASE("what cannot be looked for is refused") {
    SignatureQuery query = part_of_longest();
    query.frames = RowRange{0, longest_clip().frames + 1};
    CHECK_THROWS_AS(answers(query), UsageError);
    query.clip = "nobody";
    CHECK_THROWS_AS(answers(query), UsageError);
}

TEST_CASE("compressed motion is smaller, and off by what it says") {
    const CompressedFile file(compressed().path);
    const CompressedHead& head = file.head();
    CHECK(file.size().file == std::ssize(read_file(compressed().path)));
    CHECK(file.size().models + file.size().blocks + file.size().rest == file.size().file);
    CHECK(file.size().ratio(head) > 1);
    StoredClips clips(store().generation);
    std::vector<double> errors;
    for (const CompressedClip& clip : head.clips) {
        const StoredClip stored = clips.read(clip.name);
        const MatrixF poses =
            normalised_markers(*stored.clip.skeleton, stored.clip.motion, stored.positions);
        const auto lost = errors_of(poses, decompressed_poses(file, clip, {}));
        errors.insert(errors.end(), lost.begin(), lost.end());
    }
    const PoseErrors summary = summary_of(errors);
    CHECK(summary.rms == Approx(head.errors.rms).epsilon(1e-3));
    CHECK(summary.greatest == Approx(head.errors.greatest).epsilon(1e-3));
    CHECK(summary.rms < 20);  // the tolerance of the leaves
}

TEST_CASE("any frames of compressed motion are those of all of it") {
    const CompressedFile file(compressed().path);
    const CompressedClip& clip =
        *std::ranges::max_element(file.head().clips, {}, &CompressedClip::frames);
    const MatrixF whole = decompressed_poses(file, clip, {});
    for (int64_t first = 0; first < clip.frames; first += 101) {
        for (const int64_t count : {1, 30, 300}) {
            const RowRange some{first, std::min(first + count, clip.frames)};
            CHECK(decompressed_poses(file, clip, some) == whole.middleRows(first, some.size()));
        }
    }
    const MatrixF motion = decompressed_motion(file, clip, RowRange{200, 330}, 2).motion;
    CHECK(decompressed_motion(file, clip, RowRange{300, 320}, 1).motion ==
          motion.middleRows(100, 20));
}

TEST_CASE("compressed motion plays where and as it was taken") {
    const CompressedFile file(compressed().path);
    const CompressedClip& clip = file.head().clips.front();
    const StoredClip stored = StoredClips(store().generation).read(clip.name);
    const RowRange frames{250, 290};
    const Clip motion = decompressed_motion(file, clip, frames, 2);
    const MatrixF off =
        joint_positions(motion) - stored.positions.middleRows(frames.first, frames.size());
    const double rms = std::sqrt(off.cast<double>().squaredNorm() / double(off.size() / 3));
    CHECK(rms < 4);  // cm
}

TEST_CASE("damaged compressed motion is refused") {
    const std::string bytes = read_file(compressed().path);
    const TemporaryFolder folder;
    const auto path = folder / "damaged.motion";
    const auto read_all = [&] {
        const CompressedFile file(path);
        for (const CompressedClip& clip : file.head().clips) decompressed_poses(file, clip, {});
    };
    for (size_t part = 0; part < 40; ++part) {
        std::string damaged = bytes;
        damaged[part * bytes.size() / 40] ^= 1;
        write_file_atomically(path, damaged);
        CHECK_THROWS_AS(read_all(), StoreError);
    }
    for (const size_t length : {size_t{0}, size_t{20}, bytes.size() / 2, bytes.size() - 1}) {
        write_file_atomically(path, bytes.substr(0, length));
        CHECK_THROWS_AS(read_all(), StoreError);
    }
}
