#include "kinetome/store/store_lock.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <utility>

#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"
#include "lock_holder.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

/// A link's target; nothing when there is no link.
std::optional<std::string> target_of(const fs::path& path) {
    std::array<char, 4096> target{};
    const ssize_t length = ::readlink(path.c_str(), target.data(), target.size());
    if (length >= 0) return std::string(target.data(), static_cast<size_t>(length));
    if (errno == ENOENT) return std::nullopt;
    if (errno == EINVAL) return "";  // something else has the lock's name: nobody's lock to take
    throw create_error("read", path, errno);
}

CreateError held_by(const std::string& holder, const fs::path& path) {
    const std::string shown = path_for_message(path.string());
    return CreateError(fmt::format(
        "{} is held by {}: wait until that run ends; if that process or its machine is gone for "
        "good, remove {} and run the same command again",
        shown, holder, shown));
}

std::string describe_content(const std::string& content) {
    const auto holder = parse_holder(content);
    return holder ? describe(*holder) : "someone unknown";
}

void replace_link(const fs::path& path, const std::string& content, const std::string& nonce) {
    const fs::path fresh = path.string() + ".by-" + nonce;
    if (::symlink(content.c_str(), fresh.c_str()) != 0) throw create_error("create", fresh, errno);
    if (::rename(fresh.c_str(), path.c_str()) != 0) {
        const int error = errno;
        ::unlink(fresh.c_str());
        throw create_error("replace", path, error);
    }
}

}  // namespace

StoreLock::StoreLock(fs::path path, std::string content)
    : path_(std::move(path)), content_(std::move(content)), process_(::getpid()) {}

StoreLock::StoreLock(StoreLock&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      content_(std::move(other.content_)),
      process_(other.process_) {}

StoreLock& StoreLock::operator=(StoreLock&& other) noexcept {
    if (this == &other) return *this;
    release();
    path_ = std::exchange(other.path_, {});
    content_ = std::move(other.content_);
    process_ = other.process_;
    return *this;
}

StoreLock StoreLock::take(const fs::path& path) {
    const LockHolder self = this_process();
    const std::string mine = write_holder(self);
    for (;;) {
        if (::symlink(mine.c_str(), path.c_str()) == 0) return {path, mine};
        if (errno != EEXIST) throw create_error("create", path, errno);
        const auto found = target_of(path);
        if (!found) continue;                     // released this moment
        if (*found == mine) return {path, mine};  // a file server did what it was asked twice
        const auto holder = parse_holder(*found);
        if (!holder || !is_gone(*holder)) throw held_by(describe_content(*found), path);

        // Of all who find the holder gone, one may replace its lock: who has the lock that is named
        // after the one to be replaced. Late comers get that lock too, and find another content.
        const StoreLock right_to_replace = take(path.string() + ".after-" + holder->nonce);
        if (target_of(path) != found) continue;
        replace_link(path, mine, self.nonce);
        return {path, mine};
    }
}

void StoreLock::release() noexcept {
    if (!held() || process_ != ::getpid()) return;
    std::array<char, 4096> target{};
    const ssize_t length = ::readlink(path_.c_str(), target.data(), target.size());
    const std::string_view found(target.data(), length > 0 ? static_cast<size_t>(length) : 0);
    if (found == content_) ::unlink(path_.c_str());
    path_.clear();
}

std::optional<std::string> live_holder(const fs::path& path) {
    const auto content = target_of(path);
    if (!content) return std::nullopt;
    const auto holder = parse_holder(*content);
    if (holder && is_gone(*holder)) return std::nullopt;
    return describe_content(*content);
}

}  // namespace kinetome
