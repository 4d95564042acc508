// A store opened for reading: one generation, leased, its files checked once each.
#pragma once

#include <filesystem>
#include <string>

#include "kinetome/run/generation.h"
#include "kinetome/store/store_directory.h"

namespace kinetome {

struct OpenStore {
    /// `generation`: an id, a unique beginning of one, or "current". Throws StoreError when there
    /// is no store, or nothing was published yet.
    explicit OpenStore(const std::filesystem::path& path, const std::string& which = "current")
        : store(StoreDirectory::open(path)),
          generation(store, store.resolve_generation(which), verified) {}

    StoreDirectory store;
    VerifiedFiles verified;
    Generation generation;
};

}  // namespace kinetome
