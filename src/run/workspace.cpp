#include "kinetome/run/workspace.h"

#include <fmt/format.h>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"

namespace kinetome {
namespace fs = std::filesystem;
namespace {

fs::path receipt_path(const fs::path& folder, const std::string& file_name) {
    return folder / (file_name + ".receipt.json");
}

}  // namespace

Workspace::Workspace(StoreDirectory store, const Generation* last, VerifiedFiles& verified,
                     Purpose purpose)
    : store_(std::move(store)), last_(last), verified_(&verified), folder_(store_.run_folder()) {
    if (purpose == Purpose::look) return;
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) {
        throw CreateError(fmt::format("cannot make {}: {}", folder_.string(), error.message()));
    }
}

bool Workspace::is_intact(const FinishedWork& work) const {
    try {
        verified_->require(work.path, work.receipt.file.hash);
        return true;
    } catch (const StoreError&) {
        return false;
    }
}

ArtifactReader Workspace::open(const FinishedWork& work) const {
    return ArtifactReader(work.path, work.receipt.file.hash, *verified_);
}

std::optional<FinishedWork> Workspace::in_run(const std::string& file_name) const {
    const fs::path path = receipt_path(folder_, file_name);
    if (!fs::exists(path) || !fs::exists(folder_ / file_name)) return std::nullopt;
    try {
        return FinishedWork{parse_receipt(read_file(path), path), folder_ / file_name, false};
    } catch (const StoreError&) {
        return std::nullopt;  // a damaged receipt vouches for nothing: the work is done again
    }
}

std::optional<FinishedWork> Workspace::in_generation(const std::string& file_name) const {
    const Receipt* receipt = last_ ? last_->ledger().find(file_name) : nullptr;
    if (!receipt) return std::nullopt;
    return FinishedWork{*receipt, last_->folder() / file_name, true};
}

std::optional<FinishedWork> Workspace::find(const std::string& file_name,
                                            const StageKey& key) const {
    for (auto work : {in_generation(file_name), in_run(file_name)}) {
        if (work && work->receipt.key.digest() == key.digest() && is_intact(*work)) return work;
    }
    return std::nullopt;
}

std::string Workspace::why_missing(const std::string& file_name, const StageKey& key) const {
    const auto in_this_run = in_run(file_name);
    const auto work = in_this_run ? in_this_run : in_generation(file_name);
    if (!work) return "is new";
    const std::string difference = key.difference_from(work->receipt.key);
    return difference.empty() ? "is damaged: its bytes do not match their hash" : difference;
}

FinishedWork Workspace::commit(Receipt receipt) const {
    const std::string& name = receipt.file.file_name;
    write_file_atomically(receipt_path(folder_, name), write_receipt(receipt));
    fs::path path = folder_ / name;
    return {std::move(receipt), std::move(path), false};
}

void Workspace::remove_leftovers() const {
    for (const auto& entry : fs::directory_iterator(folder_)) {
        const std::string name = entry.path().filename().string();
        if (name.find(".writing-") == std::string::npos) continue;
        std::error_code ignored;  // a leftover that stays costs space only
        fs::remove(entry.path(), ignored);
    }
}

void Workspace::remove() const {
    std::error_code ignored;  // what stays is found again by its key, or overwritten
    fs::remove_all(folder_, ignored);
}

}  // namespace kinetome
