#include "generation_id.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace kinetome {
namespace {

constexpr std::string_view pattern = "00000000T000000Z-xxxx";
constexpr size_t time_length = 16;

std::string time_text(std::time_t time) {
    return fmt::format("{:%Y%m%dT%H%M%SZ}", fmt::gmtime(time));
}

std::time_t time_of(const std::string& id) {
    std::tm fields{};
    std::istringstream(id) >> std::get_time(&fields, "%Y%m%dT%H%M%SZ");
    return ::timegm(&fields);
}

}  // namespace

bool is_generation_id(std::string_view name) {
    const auto fits = [](char want, char found) {
        const bool digit = found >= '0' && found <= '9';
        if (want == '0') return digit;
        if (want == 'x') return digit || (found >= 'a' && found <= 'f');
        return found == want;
    };
    return name.size() == pattern.size() &&
           std::equal(pattern.begin(), pattern.end(), name.begin(), fits);
}

std::string generation_id_after(const std::string& last, std::time_t now, uint64_t content) {
    std::string time = time_text(now);
    if (time <= last.substr(0, time_length)) time = time_text(time_of(last) + 1);
    return fmt::format("{}-{:04x}", time, content & 0xFFFF);
}

}  // namespace kinetome
