// Clips of a generation by their names, out of the shards that hold their frames.
#pragma once

#include <map>
#include <string>

#include "kinetome/run/generation.h"
#include "kinetome/store/frame_store.h"

namespace kinetome {

class StoredClips {
  public:
    /// `generation` outlives it.
    explicit StoredClips(const Generation& generation) : generation_(generation) {}

    /// Throws UsageError when no such clip is indexed.
    const CatalogClip& find(const std::string& name) const;
    /// The clip whole, at its source's rate. Throws as find does, and StoreError.
    StoredClip read(const std::string& name);

  private:
    const Generation& generation_;
    std::map<std::string, FrameShardReader> shards_;  ///< those opened so far, by cut name
};

}  // namespace kinetome
