// Types made of several values, as bytes and back (packing.h).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/base/packing.h"

namespace kinetome {

inline void pack(Packer& out, const std::string& text) {
    out.put(std::string_view(text));
}
inline void unpack(Unpacker& in, std::string& text) {
    text = in.get_text();
}

/// One behind the other; unpack_all takes them in the same order.
template <class... Fields>
void pack_all(Packer& out, const Fields&... fields) {
    (pack(out, fields), ...);
}
template <class... Fields>
void unpack_all(Unpacker& in, Fields&... fields) {
    (unpack(in, fields), ...);
}

/// How many there are, and what `pack_one(value)` packs of each.
template <class T, class PackOne>
void pack_each(Packer& out, const std::vector<T>& values, const PackOne& pack_one) {
    out.put(static_cast<uint64_t>(values.size()));
    for (const T& value : values) pack_one(value);
}
/// Throws std::out_of_range where there are fewer.
template <class T, class UnpackOne>
void unpack_each(Unpacker& in, std::vector<T>& values, const UnpackOne& unpack_one) {
    values.clear();
    for (auto left = in.get<uint64_t>(); left > 0; --left) unpack_one(values.emplace_back());
}

}  // namespace kinetome
