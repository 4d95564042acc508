#include "kinetome/store/store_directory.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <thread>

#include "generation_id.h"
#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"
#include "kinetome/store/json_text.h"
#include "lock_holder.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

constexpr int store_format = 1;
constexpr std::string_view marker_name = "kinetome_store.json";

std::string shown(const fs::path& path) {
    return path_for_message(path.string());
}

std::vector<std::string> names_in(const fs::path& folder) {
    std::error_code error;
    std::vector<std::string> names;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        names.push_back(entry->path().filename().string());
    }
    if (error && error != std::errc::no_such_file_or_directory) {
        throw StoreError(fmt::format("cannot list {}: {}", shown(folder), error.message()));
    }
    std::sort(names.begin(), names.end());
    return names;
}

void make_folder(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error) throw create_error("create", path, error.value());
}

/// False when there is nothing. Throws StoreError when that cannot be told.
bool is_there(const fs::path& path) {
    std::error_code error;
    const bool found = fs::exists(path, error);
    if (error) {
        throw StoreError(fmt::format("cannot open {}: {}", shown(path), error.message()));
    }
    return found;
}

void rename_folder(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::rename(from, to, error);
    if (error) throw create_error("rename", from, error.value());
}

void remove_tree(const fs::path& path) {
    std::error_code error;
    fs::remove_all(path, error);
    if (error) throw create_error("remove", path, error.value());
}

void require_known_format(const fs::path& marker) {
    const Json json = parse_json(read_file(marker), marker, "the mark of a store");
    const int format = convert_json(json, marker, "the mark of a store", [](const Json& top) {
        return top.at("kinetome_format").get<int>();
    });
    if (format < 1) {
        throw StoreError(
            fmt::format("{} is damaged: no store has format {}", shown(marker), format));
    }
    if (format > store_format) {
        throw StoreError(fmt::format(
            "{} was made by a newer Kinetome (format {}, this one knows up to {}); use that one",
            shown(marker.parent_path()), format, store_format));
    }
}

/// Whether a store may be made in a folder that holds this: the labels a user prepared, or the mark
/// that was being written when the last attempt was killed.
bool may_lie_in_new_store(const std::string& name) {
    return name == "labels.csv" || name.starts_with(fmt::format(".{}.", marker_name));
}

/// Throws CreateError for a folder of another kind.
void require_unused(const fs::path& path) {
    const auto names = names_in(path);
    if (!std::all_of(names.begin(), names.end(), may_lie_in_new_store)) {
        throw CreateError(fmt::format(
            "{} is not a Kinetome store, and not empty: choose another folder", shown(path)));
    }
}

void mark_as_store(const fs::path& path) {
    require_unused(path);
    write_file_atomically(path / marker_name,
                          fmt::format("{{\"kinetome_format\":{}}}\n", store_format));
}

void require_plain_name(const std::string& name) {
    if (name.empty() || name.front() == '.' || name.find('/') != std::string::npos) {
        throw UsageError(quote_for_message(name) + " is no name for a slice");
    }
}

}  // namespace

StoreDirectory StoreDirectory::open(const fs::path& path) {
    const fs::path marker = path / marker_name;
    if (!is_there(path)) {
        throw StoreError(fmt::format(
            "there is no store {0}; `kinetome reindex CORPUS --store {0}` makes one", shown(path)));
    }
    if (!is_there(marker)) {
        throw StoreError(
            fmt::format("{} is not a Kinetome store: it has no {}", shown(path), marker_name));
    }
    require_known_format(marker);
    return StoreDirectory(path);
}

std::optional<StoreDirectory> StoreDirectory::find(const fs::path& path) {
    if (is_there(path / marker_name)) return open(path);
    require_unused(path);
    return std::nullopt;
}

StoreDirectory StoreDirectory::open_or_create(const fs::path& path) {
    make_folder(path);
    if (!is_there(path / marker_name)) mark_as_store(path);
    StoreDirectory store = open(path);
    for (const fs::path& folder :
         {store.generations_folder(), store.scratch(), store.locks_folder() / "slices",
          store.locks_folder() / "leases"}) {
        make_folder(folder);
    }
    return store;
}

std::optional<std::string> StoreDirectory::current() const {
    std::error_code error;
    const fs::path target = fs::read_symlink(path_ / "current", error);
    if (error == std::errc::no_such_file_or_directory) return std::nullopt;
    const std::string id = target.filename().string();
    if (error || !is_generation_id(id) || !fs::is_directory(generation_folder(id))) {
        throw StoreError(fmt::format(
            "{} names no generation of this store; point it at one of {}, or remove it and reindex",
            shown(path_ / "current"), shown(generations_folder())));
    }
    return id;
}

std::vector<std::string> StoreDirectory::generations() const {
    std::vector<std::string> ids = names_in(generations_folder());
    std::erase_if(ids, [](const std::string& name) { return !is_generation_id(name); });
    return ids;
}

fs::path StoreDirectory::generation_folder(const std::string& id) const {
    return generations_folder() / id;
}

std::string StoreDirectory::resolve_generation(const std::string& text) const {
    if (text == "current") {
        if (const auto id = current()) return *id;
        throw UsageError(fmt::format("{} has no generation yet: reindex first", shown(path_)));
    }
    std::vector<std::string> matching = generations();
    std::erase_if(matching, [&](const std::string& id) { return !id.starts_with(text); });
    if (matching.size() == 1) return matching.front();
    throw UsageError(fmt::format(
        "{} {} of {}: `kinetome info` lists them", quote_for_message(text),
        matching.empty() ? "is no generation" : "begins the names of several generations",
        shown(path_)));
}

StoreLock StoreDirectory::lock_writer() {
    const fs::path slices = locks_folder() / "slices";
    make_folder(slices);
    StoreLock lock = StoreLock::take(locks_folder() / "writer");
    // Taken and released at once: fails when a slice is held, and clears away those left by the
    // dead.
    for (const std::string& name : names_in(slices)) StoreLock::take(slices / name);
    remove_leftovers();
    return lock;
}

StoreLock StoreDirectory::lock_slice(const std::string& name) {
    require_plain_name(name);
    const fs::path slices = locks_folder() / "slices";
    make_folder(slices);
    StoreLock lock = StoreLock::take(slices / name);
    // Looked at after the own lock is there, as the writer does: at least one of both sees the
    // other.
    if (const auto writer = live_holder(locks_folder() / "writer")) {
        throw CreateError(fmt::format("{} is being written to by {}: wait until that run ends",
                                      shown(path_), *writer));
    }
    return lock;
}

std::optional<std::string> StoreDirectory::other_slice_at_work(const std::string& own) const {
    const fs::path slices = locks_folder() / "slices";
    for (const std::string& name : names_in(slices)) {
        if (name == own) continue;
        if (const auto holder = live_holder(slices / name)) return holder;
    }
    return std::nullopt;
}

StoreLock StoreDirectory::lock_record() {
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    for (;;) {
        try {
            return StoreLock::take(locks_folder() / "record");
        } catch (const CreateError&) {
            if (std::chrono::steady_clock::now() > give_up) throw;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
}

StoreLock StoreDirectory::lease(const std::string& generation) const {
    const fs::path leases = locks_folder() / "leases";
    StoreLock lease;
    try {
        make_folder(leases);
        lease = StoreLock::take(leases / (generation + "." + random_nonce()));
    } catch (const CreateError&) {
        // Then nobody is told of this reader; should its files go, it fails and can be run again.
    }
    if (live_holder(removal_lock(generation)) || !is_there(generation_folder(generation))) {
        throw StoreError(fmt::format("generation {} of {} is gone: run the command again",
                                     generation, shown(path_)));
    }
    return lease;
}

fs::path StoreDirectory::removal_lock(const std::string& generation) const {
    return locks_folder() / ("removal." + generation);
}

bool StoreDirectory::leased(const std::string& generation) const {
    const fs::path leases = locks_folder() / "leases";
    const auto names = names_in(leases);
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
        return name.starts_with(generation + ".") && live_holder(leases / name);
    });
}

std::vector<std::string> StoreDirectory::remove_old(int keep) {
    if (keep < 1) throw UsageError("at least one generation must be kept");
    remove_stale_leases();
    std::vector<std::string> old = generations(), removed;
    old.resize(old.size() - std::min(old.size(), static_cast<size_t>(keep)));
    const auto kept = current();
    for (const std::string& id : old) {
        if (id == kept) continue;
        // Leases are looked at after the intent is there, as readers do the reverse: at least one
        // of both sees the other.
        const StoreLock intent = StoreLock::take(removal_lock(id));
        if (leased(id)) continue;
        const fs::path away = generations_folder() / (".old-" + id);
        rename_folder(generation_folder(id), away);
        remove_tree(away);
        removed.push_back(id);
    }
    return removed;
}

void StoreDirectory::remove_leftovers() const {
    for (const fs::path& folder : {path_, generations_folder()}) {
        for (const std::string& name : names_in(folder)) {
            const bool is_leftover = name.starts_with(".new-") || name.starts_with(".old-") ||
                                     name.starts_with(fmt::format(".{}.", marker_name));
            if (is_leftover) remove_tree(folder / name);
        }
    }
    for (const std::string& name : names_in(locks_folder())) {
        // Of writers that were killed while they took the lock over or removed a generation.
        if (name.starts_with("writer.") || name.starts_with("removal.") ||
            name.starts_with("record."))
            remove_tree(locks_folder() / name);
    }
    remove_stale_leases();
}

void StoreDirectory::remove_stale_leases() const {
    const fs::path leases = locks_folder() / "leases";
    for (const std::string& name : names_in(leases)) {
        if (!live_holder(leases / name)) remove_tree(leases / name);
    }
}

}  // namespace kinetome
