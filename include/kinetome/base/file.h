// Files read whole and files replaced whole: after a crash or a full disk a path holds its old
// content or its new content, never a part.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "kinetome/base/error.h"

namespace kinetome {

/// All bytes of a file of the store. Throws StoreError.
std::string read_file(const std::filesystem::path& path);

/// All bytes of a file of the corpus. Throws InputError, so that the file is quarantined.
std::string read_source_file(const std::filesystem::path& path);

/// Hands a file's bytes, in order, to `take`, without holding more than one block.
/// Throws StoreError.
void read_blocks(const std::filesystem::path& path,
                 const std::function<void(std::string_view)>& take);

/// Replaces the file by `text`: temporary file in the same folder, write, sync, rename, sync of the
/// folder. Throws CreateError; then the temporary is gone and what was at `path` is still there.
/// Links are followed; into a pipe or a device the text is written as it is.
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

struct FileText {
    std::filesystem::path path;
    std::string_view text;
};

/// The same of several: all are written before the first appears.
void write_files_atomically(std::span<const FileText> files);

/// Copies a file of the store to a name where nothing is yet. Not synced. Throws StoreError for the
/// source, CreateError for the target; then nothing is left there.
void copy_to_new_file(const std::filesystem::path& source, const std::filesystem::path& target);

/// Returns when the file's bytes are on the disk. Throws CreateError.
void fsync_path(const std::filesystem::path& path);

/// Returns when the names in the folder (a rename, a link) are on the disk. Throws CreateError.
void fsync_directory(const std::filesystem::path& path);

/// For a failed call that set errno to `error_number`: "cannot <action> <path>: <reason>;
/// <advice>".
CreateError create_error(std::string_view action, const std::filesystem::path& path,
                         int error_number);

}  // namespace kinetome
