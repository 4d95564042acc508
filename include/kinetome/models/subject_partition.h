// One mixture for the whole corpus, or one a subject: skeletons and calibration set subjects apart
// so well that large corpora gain nothing from sharing letters between them.
#pragma once

#include <cstdint>
#include <optional>
#include <regex>
#include <string>

namespace kinetome {

enum class PartitionRule { none, subject, automatic };

/// Most frames that `automatic` keeps in one mixture.
inline constexpr int64_t most_frames_together = 50'000;

/// Whether each subject of a corpus of this many frames gets principal components, κ and τ of its
/// own.
bool partition_by_subject(PartitionRule rule, int64_t frames);

/// The subject of the take at `path`, which is relative to the corpus: what the first group of
/// `pattern` captures where it first matches the path, else the folder the take lies in ("" at the
/// top). Throws std::invalid_argument for a pattern without a group.
std::string subject_of(const std::string& path,
                       const std::optional<std::regex>& pattern = std::nullopt);

}  // namespace kinetome
