// A store as anybody finds it on disk.
#pragma once

#include <sys/stat.h>

#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>

#include "kinetome/base/csv.h"
#include "program.h"
#include "texts.h"

class StoreOnDisk {
  public:
    explicit StoreOnDisk(fs::path path) : path_(std::move(path)) {}

    const fs::path& path() const { return path_; }
    std::string name() const { return path_.string(); }
    fs::path run_folder() const { return path_ / "scratch" / "run"; }

    /// Of the clustering, in the run in progress.
    bool has_checkpoint() const {
        if (!fs::exists(run_folder())) return false;
        for (const auto& entry : fs::directory_iterator(run_folder())) {
            const std::string file_name = entry.path().filename().string();
            if (file_name.rfind("checkpoint-", 0) == 0 && !contains(file_name, ".writing-")) {
                return true;
            }
        }
        return false;
    }

    /// Id that `current` names; nothing when there is no such link.
    std::optional<std::string> current() const {
        if (!fs::is_symlink(path_ / "current")) return std::nullopt;
        return fs::read_symlink(path_ / "current").filename().string();
    }
    fs::path file(const std::string& name) const { return path_ / "current" / name; }

    std::set<std::string> generations() const {
        std::set<std::string> names;
        if (!fs::exists(path_ / "generations")) return names;
        for (const auto& entry : fs::directory_iterator(path_ / "generations")) {
            names.insert(entry.path().filename().string());
        }
        return names;
    }

    /// Artifacts of the current generation.
    std::set<std::string> artifacts(const std::string& beginning = "") const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(path_ / "current/")) {
            const std::string file_name = entry.path().filename().string();
            if (entry.path().extension() == ".h5" && file_name.rfind(beginning, 0) == 0) {
                names.insert(file_name);
            }
        }
        return names;
    }

    /// Bytes of every artifact, by name.
    std::map<std::string, std::string> artifact_bytes() const {
        std::map<std::string, std::string> bytes;
        for (const std::string& one : artifacts()) bytes[one] = text_of(file(one));
        return bytes;
    }

    /// Identity on the file system of every artifact, by name.
    std::map<std::string, ino_t> artifact_inodes() const {
        std::map<std::string, ino_t> inodes;
        for (const std::string& one : artifacts()) {
            struct stat status {};
            if (::stat(file(one).c_str(), &status) != 0)
                throw std::runtime_error("cannot stat " + one);
            inodes[one] = status.st_ino;
        }
        return inodes;
    }

    /// What `verify --digest` prints: one line a dataset. Requires that the store is whole.
    std::string digests() const {
        const CommandResult result = require_program({"verify", name(), "--digest"});
        REQUIRE(!result.output.empty());
        return result.output;
    }

  private:
    fs::path path_;
};

/// What `export clips` tells of a clip.
struct ClipState {
    std::string source, state, reason;
};

/// By name.
inline std::map<std::string, ClipState> clips_in(const fs::path& store) {
    const CommandResult exported = require_program({"export", store.string(), "clips"});
    auto records = kinetome::parse_csv(exported.output, "clips");
    REQUIRE(records.at(0).fields == std::vector<std::string>{"clip", "source", "class", "rate",
                                                             "frames", "state", "reason"});
    records.erase(records.begin());
    std::map<std::string, ClipState> clips;
    for (const kinetome::CsvRecord& record : records) {
        REQUIRE(record.fields.size() == 7);
        const auto text = [&](size_t i) { return kinetome::from_csv_text(record.fields[i]); };
        clips[text(0)] = {text(1), text(5), text(6)};
    }
    REQUIRE(clips.size() == records.size());
    return clips;
}
