// A generation that can be told whole from torn, and what is needed to publish some.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "kinetome/base/digest.h"
#include "kinetome/base/file.h"
#include "kinetome/store/store_directory.h"

namespace store_example {

namespace fs = std::filesystem;

inline std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

/// Publishes three files made in the scratch folder, and a text that lists them with their hashes.
inline std::string publish(kinetome::StoreDirectory& store, const std::string& content,
                           bool copy = false) {
    fs::create_directories(store.run_folder());
    std::vector<kinetome::StoreDirectory::File> files;
    std::string list;
    for (const std::string name : {"frames-0.h5", "frames-1.h5", "bundles.h5"}) {
        const fs::path made = store.run_folder() / name;
        const std::string text = content + " of " + name;
        fs::remove(made);  // not written over: generations share it
        std::ofstream(made) << text;
        files.push_back({name, made});
        list += name + " " + kinetome::digest_of(text).hex() + "\n";
    }
    return store.publish(files, {{"list.txt", list}}, copy);
}

/// "" or what is missing or wrong in a generation that publish() made.
inline std::string fault_in(const fs::path& folder) {
    std::istringstream list(kinetome::read_file(folder / "list.txt"));
    std::string name, hash;
    size_t files = 1;
    for (; list >> name >> hash; ++files) {
        if (!fs::exists(folder / name)) return name + " is missing";
        if (kinetome::digest_file(folder / name).hex() != hash) return name + " is damaged";
    }
    return files == 4 && names_in(folder).size() == files ? "" : "the number of files is wrong";
}

}  // namespace store_example
