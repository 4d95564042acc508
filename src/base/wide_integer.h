// 128-bit integers, which every 64-bit GCC and Clang has and ISO C++ does not name.
#pragma once

namespace kinetome {

__extension__ using WideUnsigned = unsigned __int128;

}  // namespace kinetome
