// Ids of generations: the time of publishing and a hash of the content, "20261122T021500Z-3f9a".
// Their order as texts is the order of publishing.
#pragma once

#include <cstdint>
#include <ctime>
#include <string>
#include <string_view>

namespace kinetome {

bool is_generation_id(std::string_view name);

/// An id of `now`, or of the second after `last` where that is not earlier (two in one second, or a
/// clock that went back). `last` is "" when there is none.
std::string generation_id_after(const std::string& last, std::time_t now, uint64_t content);

}  // namespace kinetome
