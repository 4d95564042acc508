#include "kinetome/formats/take_format.h"

#include <algorithm>
#include <array>

#include "kinetome/formats/asf_amc.h"

namespace kinetome {
namespace {

Clip parse_amc_take(const TakeSource& source) {
    return parse_amc(source.bytes, source.path, source.skeleton, {.rate = source.default_rate});
}

constexpr std::array formats = {
    TakeFormat{.extension = ".amc",
               .skeleton_extension = ".asf",
               .count_frames = count_amc_frames,
               .parse = parse_amc_take},
};

char lower_case(char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

}  // namespace

std::span<const TakeFormat> take_formats() {
    return formats;
}

const TakeFormat* find_take_format(std::string_view extension) {
    const auto same = [&](const TakeFormat& format) {
        return std::ranges::equal(format.extension, extension, {}, {}, lower_case);
    };
    const auto found = std::ranges::find_if(formats, same);
    return found == formats.end() ? nullptr : &*found;
}

}  // namespace kinetome
