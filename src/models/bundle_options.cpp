#include "kinetome/models/bundle_options.h"

#include <charconv>
#include <stdexcept>

namespace kinetome {
namespace {

constexpr std::string_view depth_prefix = "depth:";

}  // namespace

std::string spread_text(const MotionBundleOptions& options) {
    switch (options.spread) {
        case BundleSpread::closure:
            return "closure";
        case BundleSpread::closure_near:
            return "closure-near";
        case BundleSpread::closure_length:
            return "closure-length";
        case BundleSpread::depth:
            break;
    }
    return std::string(depth_prefix) + std::to_string(options.depth);
}

void parse_spread(std::string_view text, MotionBundleOptions& options) {
    for (const BundleSpread spread :
         {BundleSpread::closure, BundleSpread::closure_near, BundleSpread::closure_length}) {
        MotionBundleOptions named;
        named.spread = spread;
        if (text != spread_text(named)) continue;
        options.spread = spread;
        return;
    }
    if (text.starts_with(depth_prefix)) {
        const std::string_view digits = text.substr(depth_prefix.size());
        int32_t depth = 0;
        const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), depth);
        if (read.ec == std::errc() && read.ptr == digits.data() + digits.size() && depth > 0) {
            options.spread = BundleSpread::depth;
            options.depth = depth;
            return;
        }
    }
    throw std::invalid_argument("'" + std::string(text) +
                                "' is none of closure, closure-near, closure-length, depth:N with "
                                "N of 1 or more");
}

}  // namespace kinetome
