#include "kinetome/formats/take_format.h"

#include <algorithm>
#include <array>

#include "kinetome/formats/asf_amc.h"
#include "text_lines.h"

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

}  // namespace

std::span<const TakeFormat> take_formats() {
    return formats;
}

const TakeFormat* find_take_format(std::string_view extension) {
    const auto found = std::ranges::find(formats, lower_case(extension), &TakeFormat::extension);
    return found == formats.end() ? nullptr : &*found;
}

}  // namespace kinetome
