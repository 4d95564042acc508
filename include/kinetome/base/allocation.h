// How freed memory is treated.
#pragma once

namespace kinetome {

/// Lets the allocator keep what is freed, up to 64 MiB an arena, rather than give it back to the
/// system. Sums of large models are taken and freed piece after piece, and each time the system
/// would have to clear their pages again. Called once, before the first thread starts; does nothing
/// where the C library is not glibc.
void keep_freed_memory();

}  // namespace kinetome
