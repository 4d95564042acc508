#include <catch2/catch.hpp>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/formats/asf_amc.h"
#include "replaced.h"
#include "small_rig.h"
#include "support/test_corpus.h"

using namespace kinetome;
using Catch::Contains;
using Catch::StartsWith;

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double unit = 2.54 / 0.45;

Clip parse(const std::string& text) {
    return parse_amc(text, "take.amc", small_skeleton());
}

void check_refused(const std::string& text, int64_t line, const std::string& why) {
    INFO(line << ": " << why);
    try {
        parse(text);
        FAIL("it was accepted");
    } catch (const InputError& error) {
        CHECK_THAT(error.what(), StartsWith("take.amc:" + std::to_string(line) + ": expected "));
        CHECK_THAT(error.what(), Contains(why));
    }
}

}  // namespace

TEST_CASE("a take's numbers land in their columns, in centimetres and radians") {
    const Clip clip = parse(small_amc(3));
    REQUIRE(clip.frames() == 3);
    REQUIRE(clip.motion.cols() == 15);
    CHECK(clip.rate == 120.0);
    CHECK(clip.warnings.empty());
    CHECK(clip.motion(0, 1) == static_cast<float>(17.25 * unit));
    CHECK(clip.motion(1, 4) == static_cast<float>(-170.5 * degree));
    CHECK(clip.motion(2, 8) == static_cast<float>(1.39149e-015 * degree));
    CHECK(clip.motion(2, 9) == static_cast<float>(40.125 * degree));
    CHECK(clip.motion(2, 14) == static_cast<float>(3 * degree));
}

TEST_CASE("radians are taken as they are, whether the take or its ASF says so") {
    const std::string radians = replaced(small_amc(1), ":DEGREES", ":RADIANS");
    CHECK(parse(radians).motion(0, 12) == 1.0F);
    const auto skeleton = std::make_shared<const Skeleton>(
        parse_asf(replaced(small_asf, "angle deg", "angle rad"), "small.asf"));
    const std::string unstated = replaced(small_amc(1), ":DEGREES\n", "");
    CHECK(parse_amc(unstated, "a", skeleton).motion(0, 12) == 1.0F);
    CHECK(parse_amc(small_amc(1), "a", skeleton).motion(0, 12) == static_cast<float>(degree));
}

TEST_CASE("joints in another order in each frame, CRLF, tabs and comments change nothing") {
    const Clip expected = parse(small_amc(3));
    std::string text = ":FULLY-SPECIFIED\n:DEGREES\n" + small_frame(1);
    text += "\n# a comment\n2\nspine\t1 2  3 \nfoot 7 -8 # another\n  shin 40.125\n";
    text += "root 1.5 17.25 -2 10 -170.5 5\nthigh -20 5 1.39149e-015\n";
    text += small_frame(3);
    std::string crlf;
    for (const char letter : text) crlf += letter == '\n' ? "\r\n" : std::string(1, letter);
    CHECK(parse(text).motion == expected.motion);
    CHECK(parse(crlf).motion == expected.motion);
    CHECK(count_amc_frames(crlf) == 3);
}

TEST_CASE("a take may begin at any frame number, end without a newline and state its rate") {
    std::string text = ":SAMPLES-PER-SECOND 60\n" + small_frame(0) + small_frame(1);
    text.pop_back();
    const Clip clip = parse(text);
    CHECK(clip.frames() == 2);
    CHECK(clip.rate == 60.0);
    CHECK(parse(small_frame(417)).frames() == 1);
    CHECK(parse_amc(small_frame(1), "a", small_skeleton(), {.rate = 30}).rate == 30.0);
}

TEST_CASE("a damaged take is refused, naming the line, what was expected and what was found") {
    const std::string whole = small_amc(3);  // frames begin at lines 4, 10 and 16
    const auto change = [&](const std::string& from, const std::string& to) {
        return replaced(whole, from, to);
    };
    SECTION("a number too few") {
        check_refused(change("foot 7 -8", "foot 7"), 8,
                      "2 numbers of bone 'foot', found the end of the line");
        check_refused(change("shin 40.125", "shin"), 7, "1 number of bone 'shin'");
    }
    SECTION("a number too many") {
        check_refused(change("foot 7 -8", "foot 7 -8 9"), 8, "found '9'");
    }
    SECTION("a bone the skeleton does not have") {
        check_refused(change("foot 7 -8", "tail 7 -8"), 8, "a bone of the skeleton, found 'tail'");
    }
    SECTION("what is not a number") {
        for (const std::string bad : {"x", "7x", "7.5.1", "0x7", "1e999", "--7", "1e41", "-1e300",
                                      "nan", "inf", "-nan", "NaN", "Infinity", "7,5"}) {
            check_refused(change("foot 7 -8", "foot 7 " + bad), 8,
                          "a finite number, found '" + bad + "'");
        }
    }
    SECTION("a frame number out of order") {
        check_refused(change("\n2\n", "\n3\n"), 10, "frame 2, found '3'");
        check_refused(change("\n2\n", "\n1\n"), 10, "frame 2, found '1'");
        check_refused(change("\n2\n", "\n2.5\n"), 10, "frame 2, found '2.5'");
        check_refused(change("\n2\n", "\n99999999999999999999\n"), 10, "frame 2");
        check_refused(change("\n2\n", "\n2 2\n"), 10, "nothing after the number of a frame");
    }
    SECTION("a bone twice, a bone missing") {
        check_refused(change("foot 7 -8\n", "foot 7 -8\nfoot 7 -8\n"), 9,
                      "each bone once in a frame, found 'foot' again in frame 1");
        check_refused(change("foot 7 -8\n", ""), 9, "bone 'foot' in frame 1, found the next frame");
    }
    SECTION("no frames") {
        check_refused("", 1, "no frame at all");
        check_refused(":FULLY-SPECIFIED\n:DEGREES\n", 3, "no frame at all");
    }
    SECTION("something else than a take") {
        check_refused("HIERARCHY\n", 1, "found 'HIERARCHY'");
        check_refused(":DELTA\n", 1, "found ':DELTA'");
        check_refused(std::string("\x89PNG\r\n\x1a\n\0\0", 10), 1, "found '\\x89PNG'");
        check_refused(replaced(whole, "foot 7", std::string("foot\0 7", 7)), 8, "'foot\\x00'");
        check_refused(replaced(whole, "foot 7", std::string("foot 7\0", 7)), 8, "'7\\x00'");
        check_refused(replaced(whole, "foot", "\x1b[2J"), 8, "'\\x1b[2J'");
        check_refused(":SAMPLES-PER-SECOND 0\n" + whole, 1, "a rate of 1 to 100000");
    }
}

TEST_CASE("a clip cut in mid-frame is refused, naming the line") {
    const std::string whole = small_amc(3);
    check_refused(whole.substr(0, whole.rfind("foot")), 20, "found the end of the file");
    check_refused(whole.substr(0, whole.rfind("spine 1 2 3") + 7), 21, "3 numbers of bone 'spine'");
    check_refused(whole.substr(0, whole.rfind("3\nroot") + 2), 17, "bone 'root' in frame 3");
    check_refused(whole.substr(0, whole.rfind("spine") - 1), 20, "bone 'spine' in frame 3");
}

TEST_CASE("only the very last line may be missing: its bone is held, and the clip says so") {
    const std::string before = replaced(small_frame(2), "spine 1 2 3", "spine 41 42 43");
    std::string cut = small_frame(1) + before + small_frame(3);
    cut.resize(cut.rfind("spine"));
    const Clip clip = parse(cut);
    REQUIRE(clip.frames() == 3);
    CHECK(clip.motion(2, 13) == static_cast<float>(42 * degree));
    CHECK(clip.motion.row(2) == clip.motion.row(1));
    REQUIRE(clip.warnings.size() == 1);
    CHECK_THAT(clip.warnings[0], Contains("'spine'"));
    // In the first frame there is nothing to hold it at.
    const std::string first = small_amc(1);
    check_refused(first.substr(0, first.rfind("spine")), 9, "bone 'spine' in frame 1");
}

TEST_CASE("frames are counted without being read") {
    CHECK(count_amc_frames("") == 0);
    CHECK(count_amc_frames(small_amc(17)) == 17);
    CHECK(count_amc_frames("\n\n 1\r\nroot 1\n\t2\nroot 2\n#3\n") == 2);
}

TEST_CASE("a text that claims millions of frames of a huge rig is not believed") {
    std::string asf = ":units\nlength 1\n:root\norder RX\n:bonedata\n";
    std::string hierarchy = ":hierarchy\nroot";
    for (int i = 0; i < 4000; ++i) {
        const std::string name = "b" + std::to_string(i);
        asf += "begin\nname " + name + "\ndirection 0 1 0\nlength 1\ndof rx ry rz\nend\n";
        hierarchy += " " + name;
    }
    const auto rig = std::make_shared<const Skeleton>(parse_asf(asf + hierarchy, "huge.asf"));
    std::string text;
    for (int i = 0; i < 5000000; ++i) text += "1\n";  // 240 GB of motion, had they been frames
    CHECK_THROWS_WITH(parse_amc(text, "take.amc", rig),
                      Contains("bone 'root' in frame 1, found the next frame"));
}

TEST_CASE("all 211 takes of the corpus parse to the 331893 frames they claim") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    int64_t takes = 0;
    int64_t frames = 0;
    std::string mended;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*corpus / "cmu")) {
        if (entry.path().extension() != ".amc") continue;
        const std::filesystem::path folder = entry.path().parent_path();
        const std::filesystem::path asf = folder / (folder.filename().string() + ".asf");
        const auto skeleton =
            std::make_shared<const Skeleton>(parse_asf(read_source_file(asf), asf.string()));
        const std::string text = read_source_file(entry.path());
        const Clip clip = parse_amc(text, entry.path().string(), skeleton);
        CHECK(clip.frames() == count_amc_frames(text));
        if (!clip.warnings.empty()) mended += entry.path().stem().string();
        frames += clip.frames();
        ++takes;
    }
    CHECK(takes == 211);
    CHECK(frames == 331893);
    CHECK(mended == "07_12");
}
