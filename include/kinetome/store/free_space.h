// What may still be written to the disk that holds a folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace kinetome {

struct FreeSpace {
    uint64_t bytes = 0;
    std::optional<uint64_t> inodes;  ///< files and folders; nothing where they are not counted
};

/// For a folder that need not exist yet: of its nearest parent that does. Root's reserve does not
/// count. Throws StoreError.
FreeSpace free_space(const std::filesystem::path& folder);

}  // namespace kinetome
