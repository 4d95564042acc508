#include "frame_range.h"

#include <fmt/format.h>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/base/whole_number.h"

namespace kinetome::cli {

RowRange parse_frame_range(const std::string& text) {
    const size_t colon = text.find(':');
    if (colon != std::string::npos) {
        const std::string_view all = text;
        const auto first = whole_number<int64_t>(all.substr(0, colon));
        const auto end = whole_number<int64_t>(all.substr(colon + 1));
        if (first && end && *first >= 0 && *first < *end) return {*first, *end};
    }
    throw UsageError(fmt::format("--frames {}: expected A:B, from frame A to before frame B",
                                 quote_for_message(text)));
}

}  // namespace kinetome::cli
