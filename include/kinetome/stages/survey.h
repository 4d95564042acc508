// What is in a corpus folder: every take found, its name, its content and what it claims, before
// anything is parsed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/digest.h"
#include "kinetome/base/log.h"
#include "kinetome/base/pieces.h"
#include "kinetome/base/stop.h"

namespace kinetome {

/// A file of a known format.
struct Take {
    std::string name;             ///< stem, or the shortest distinguishing path
    std::string source;           ///< path below the corpus, '/' between folders
    std::string skeleton_source;  ///< the ASF of an AMC, likewise; "" when the take holds its own
    Digest content;               ///< of its bytes and its skeleton's
    int64_t claimed_frames = 0;
    uint64_t bytes = 0;
    std::string
        quarantined;  ///< why it cannot be read at all: no skeleton, duplicate, no permission

    bool operator==(const Take&) const = default;
};

struct Survey {
    std::filesystem::path corpus;
    std::vector<Take> takes;  ///< sorted by name; the order of everything that follows
    /// What to do about a take that is no longer what it was when it was surveyed.
    std::string remedy_for_change = "run the same command again";

    int64_t claimed_frames() const;
    /// Extents for planning shards and groups (rows = 0).
    std::vector<ClipExtent> extents() const;
};

/// Content of a take: its bytes and those of its skeleton file (none: a zero digest).
Digest content_digest(std::string_view take, const Digest& skeleton);

/// Walks the folder, reads and hashes every take, in parallel and shared by all ranks, who return
/// the same. Files of other kinds are passed over. Throws Error(nothing_usable) when the folder is
/// missing or holds no take at all.
Survey survey_corpus(const std::filesystem::path& corpus, const Workers& workers, const Log& log,
                     const StopToken& stop);

/// Names for paths below a corpus: the stem where it is unique, else as many parent folders as
/// tell the paths apart, else the whole path with its extension.
std::vector<std::string> name_takes(const std::vector<std::string>& paths);

}  // namespace kinetome
