// Damage at every byte: a text either parses or is refused; nothing else may happen. Run under the
// sanitizers this also shows that nothing is read beyond the text's end.
#include <catch2/catch.hpp>
#include <string>

#include "kinetome/base/error.h"
#include "kinetome/formats/asf_amc.h"
#include "small_rig.h"

using namespace kinetome;

namespace {

/// Parses a copy of exactly the text's size, and holds what is accepted to the text's size.
void parse_or_refuse_amc(const std::string& text, const std::shared_ptr<const Skeleton>& skeleton) {
    const std::vector<char> exact(text.begin(), text.end());
    const std::string_view view(exact.data(), exact.size());
    try {
        const Clip clip = parse_amc(view, "damaged.amc", skeleton);
        CHECK(clip.frames() == count_amc_frames(view));
        CHECK(clip.motion.allFinite());
    } catch (const InputError&) {
        SUCCEED();
    }
}

void parse_or_refuse_asf(const std::string& text) {
    const std::vector<char> exact(text.begin(), text.end());
    try {
        const Skeleton skeleton = parse_asf({exact.data(), exact.size()}, "damaged.asf");
        CHECK(skeleton.joint_count() >= 1);
    } catch (const InputError&) {
        SUCCEED();
    }
}

constexpr std::string_view bad_bytes("\0\n #:(-.9e\x1b\xff", 12);

}  // namespace

TEST_CASE("an AMC cut at any byte parses or is refused") {
    const std::string text = small_amc(3);
    const auto skeleton = small_skeleton();
    for (size_t length = 0; length <= text.size(); ++length) {
        parse_or_refuse_amc(text.substr(0, length), skeleton);
    }
}

TEST_CASE("an AMC with any byte changed, dropped or doubled parses or is refused") {
    const std::string text = small_amc(3);
    const auto skeleton = small_skeleton();
    for (size_t at = 0; at < text.size(); ++at) {
        for (const char bad : bad_bytes) {
            std::string damaged = text;
            damaged[at] = bad;
            parse_or_refuse_amc(damaged, skeleton);
        }
        for (int bit = 0; bit < 8; ++bit) {
            std::string damaged = text;
            damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
            parse_or_refuse_amc(damaged, skeleton);
        }
        parse_or_refuse_amc(std::string(text).erase(at, 1), skeleton);
        parse_or_refuse_amc(std::string(text).insert(at, 1, text[at]), skeleton);
    }
}

TEST_CASE("an ASF cut at any byte, or with any byte changed, parses or is refused") {
    for (size_t at = 0; at < small_asf.size(); ++at) {
        parse_or_refuse_asf(small_asf.substr(0, at));
        for (const char bad : bad_bytes) {
            std::string damaged = small_asf;
            damaged[at] = bad;
            parse_or_refuse_asf(damaged);
        }
    }
}

TEST_CASE("an ASF with any line dropped or doubled parses or is refused") {
    size_t begin = 0;
    while (begin < small_asf.size()) {
        const size_t end = small_asf.find('\n', begin) + 1;
        const std::string line = small_asf.substr(begin, end - begin);
        parse_or_refuse_asf(std::string(small_asf).erase(begin, line.size()));
        parse_or_refuse_asf(std::string(small_asf).insert(begin, line));
        begin = end;
    }
}
