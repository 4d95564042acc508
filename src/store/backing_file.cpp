#include "backing_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"

namespace kinetome::h5 {

BackingFile BackingFile::create_new(const std::filesystem::path& path,
                                    const std::filesystem::path& shown) {
    const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) throw create_error("create", shown, errno);
    return {descriptor, 0};
}

BackingFile BackingFile::open_to_read(const std::filesystem::path& path) {
    BackingFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC), 0);
    struct stat status {};
    if (file.descriptor_ < 0 || ::fstat(file.descriptor_, &status) != 0) {
        throw StoreError("cannot open " + path.string() + ": " +
                         std::generic_category().message(errno));
    }
    file.size_ = static_cast<uint64_t>(status.st_size);
    return file;
}

BackingFile::~BackingFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

BackingFile::BackingFile(BackingFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      error_(other.error_),
      discarded_(other.discarded_) {}

bool BackingFile::read(uint64_t offset, void* data, size_t bytes) const {
    auto* target = static_cast<char*>(data);
    while (bytes > 0) {
        const ssize_t got = ::pread(descriptor_, target, bytes, static_cast<off_t>(offset));
        if (got < 0) {
            if (errno == EINTR) continue;
            return false;
        }
        if (got == 0) {
            std::memset(target, 0, bytes);
            break;
        }
        target += got;
        offset += static_cast<uint64_t>(got);
        bytes -= static_cast<size_t>(got);
    }
    return true;
}

void BackingFile::write(uint64_t offset, const void* data, size_t bytes) {
    const auto* source = static_cast<const char*>(data);
    size_ = std::max(size_, offset + bytes);
    while (bytes > 0 && !discarded_) {
        const ssize_t put = ::pwrite(descriptor_, source, bytes, static_cast<off_t>(offset));
        if (put < 0) {
            if (errno == EINTR) continue;
            return fail();
        }
        source += put;
        offset += static_cast<uint64_t>(put);
        bytes -= static_cast<size_t>(put);
    }
}

void BackingFile::resize(uint64_t bytes) {
    size_ = bytes;
    if (!discarded_ && ::ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0) fail();
}

void BackingFile::close() {
    if (::close(std::exchange(descriptor_, -1)) != 0) fail();
}

void BackingFile::fail() {
    if (error_ == 0) error_ = errno;
    discarded_ = true;
}

}  // namespace kinetome::h5
