// The catalog of a generation: every take found, what became of it, and what it is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "kinetome/base/digest.h"

namespace kinetome {

/// A clip's id: 53 bits of its name's hash (exact in every reader, JavaScript's too). It depends on
/// the name alone, so an added take leaves all other ids as they are.
int64_t clip_id(std::string_view name);

struct CatalogClip {
    std::string name;
    int64_t id = 0;
    std::string source;           ///< path below the corpus folder
    Digest content;               ///< of the take's bytes and its skeleton's
    std::string skeleton_source;  ///< path below the corpus folder; "" when the take holds it
    int64_t claimed_frames = 0;   ///< what the source claims before it is parsed
    int64_t frames = 0;           ///< indexed frames at the source's rate; 0 when quarantined
    double rate = 0;              ///< frames a second
    std::string clip_class;       ///< skeleton class; "" when quarantined
    std::vector<std::string> capabilities;       ///< "angles", "effectors", "markers"
    std::string shard;                           ///< cut name of its shard
    std::string quarantined;                     ///< reason; "" when indexed
    std::map<std::string, std::string> skipped;  ///< stage → why it left this clip out
    std::vector<std::string> warnings;

    bool indexed() const { return quarantined.empty(); }
};

struct Catalog {
    std::string corpus;                ///< folder it was read from, as given
    std::vector<CatalogClip> clips;    ///< sorted by name
    std::vector<std::string> removed;  ///< names the last generation had and this one has not

    int64_t indexed() const;
    int64_t quarantined() const;
    int64_t frames() const;
};

/// JSON with one clip a line, stable order. parse throws StoreError naming the path.
std::string write_catalog(const Catalog& catalog);
Catalog parse_catalog(std::string_view json, const std::filesystem::path& path);

}  // namespace kinetome
