// Checkpoints inside a stage: small files in the run folder that a killed run goes on from.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace kinetome {

/// Replaces the file as a whole. Not synced: a checkpoint guards against a killed process, and
/// after a power failure its hash tells. Throws CreateError.
void save_checkpoint(const std::filesystem::path& path, std::string_view bytes);

/// What was saved; nothing when there is no whole checkpoint at `path`.
std::optional<std::string> load_checkpoint(const std::filesystem::path& path);

}  // namespace kinetome
