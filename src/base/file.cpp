#include "kinetome/base/file.h"

#include <fmt/format.h>

#include <cstdio>
#include <deque>
#include <optional>
#include <system_error>
#include <vector>

#include "descriptor.h"
#include "kinetome/base/file_writer.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

constexpr size_t block_bytes = size_t{1} << 20;

std::string reason_of(int error_number) {
    return std::generic_category().message(error_number);
}

/// 0, or the errno of the call that failed.
template <class Take>
int read_all(const fs::path& path, Take&& take) {
    const Descriptor file(path, O_RDONLY);
    if (!file.valid()) return errno;
    std::vector<char> block(block_bytes);
    for (;;) {
        const ssize_t got = ::read(file.number(), block.data(), block.size());
        if (got > 0) {
            take(std::string_view(block.data(), static_cast<size_t>(got)));
        } else if (got == 0) {
            return 0;
        } else if (errno != EINTR) {
            return errno;
        }
    }
}

StoreError read_error(const fs::path& path, int error_number) {
    return StoreError(fmt::format("cannot read {}: {}", path.string(), reason_of(error_number)));
}

std::string_view advice_for(int error_number) {
    switch (error_number) {
        case ENOSPC:
            return "disk full: free space there or choose another folder, then run the same "
                   "command again";
        case EDQUOT:
            return "quota exhausted: free space of yours there or choose another folder, then run "
                   "the same command again";
        case EACCES:
        case EPERM:
        case EROFS:
            return "choose a folder you may write to, or ask its owner for permission";
        case ENOENT:
        case ENOTDIR:
            return "check that the folder exists";
        case EISDIR:
            return "name a file, not a folder";
        default:
            return "check the disk, then run the same command again";
    }
}

/// False, with errno set, when not all could be written.
bool write_all(const Descriptor& file, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t put = ::write(file.number(), bytes.data(), bytes.size());
        if (put >= 0) {
            bytes.remove_prefix(static_cast<size_t>(put));
        } else if (errno != EINTR) {
            return false;
        }
    }
    return true;
}

/// A new file beside `path`, removed on destruction unless it was renamed to it.
class TemporaryFile {
  public:
    explicit TemporaryFile(const fs::path& path) : target_(path), file_(open_beside(path)) {}
    ~TemporaryFile() {
        if (!renamed_) ::unlink(temporary_.c_str());
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void write(std::string_view text) {
        if (!write_all(file_, text)) fail("write");
    }

    void sync_and_rename() {
        if (::fsync(file_.number()) != 0 || !file_.close()) fail("write");
        if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("replace");
        renamed_ = true;
    }

    const fs::path& target() const { return target_; }

  private:
    /// Not mkstemp: its files are private, and these shall have the permissions of any new file.
    Descriptor open_beside(const fs::path& path) {
        for (int attempt = 0;; ++attempt) {
            temporary_ = path;
            temporary_.replace_filename(
                fmt::format(".{}.writing-{}-{}", path.filename().string(), ::getpid(), attempt));
            Descriptor file(temporary_, O_WRONLY | O_CREAT | O_EXCL, 0666);
            if (file.valid()) return file;
            if (errno != EEXIST) fail("create");
        }
    }

    [[noreturn]] void fail(std::string_view action) const {
        throw create_error(action, target_, errno);
    }

    fs::path target_;
    fs::path temporary_;
    Descriptor file_;
    bool renamed_ = false;
};

/// A pipe or a device, which no file may take the place of.
class Stream {
  public:
    explicit Stream(const fs::path& path) : path_(path), file_(path, O_WRONLY) {
        if (!file_.valid()) throw create_error("write", path_, errno);
    }
    void write(std::string_view text) {
        if (!write_all(file_, text)) throw create_error("write", path_, errno);
    }

  private:
    fs::path path_;
    Descriptor file_;
};

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// What is replaced when `path` is: links are followed.
fs::path target_of(const fs::path& path) {
    std::error_code none;
    fs::path target = fs::is_symlink(path, none) ? fs::weakly_canonical(path, none) : path;
    if (fs::is_directory(fs::status(target, none))) throw create_error("replace", target, EISDIR);
    return target;
}

bool is_stream(const fs::path& target) {
    std::error_code none;
    const fs::file_status there = fs::status(target, none);
    return fs::exists(there) && !fs::is_regular_file(there);
}

}  // namespace

std::string read_file(const fs::path& path) {
    std::string text;
    read_blocks(path, [&text](std::string_view block) { text.append(block); });
    return text;
}

std::string read_source_file(const fs::path& path) {
    std::string text;
    const int error = read_all(path, [&text](std::string_view block) { text.append(block); });
    if (error != 0) throw InputError::in_file(path.string(), "cannot be read: " + reason_of(error));
    return text;
}

void read_blocks(const fs::path& path, const std::function<void(std::string_view)>& take) {
    const int error = read_all(path, take);
    if (error != 0) throw read_error(path, error);
}

void write_file_atomically(const fs::path& path, std::string_view text) {
    const FileText one[] = {{path, text}};
    write_files_atomically(one);
}

void write_files_atomically(std::span<const FileText> files) {
    std::deque<TemporaryFile> written;
    std::vector<FileText> streams;
    for (const auto& [path, text] : files) {
        const fs::path target = target_of(path);
        if (is_stream(target)) {
            streams.push_back({target, text});
        } else {
            written.emplace_back(target).write(text);
        }
    }
    for (const auto& [path, text] : streams) Stream(path).write(text);
    for (TemporaryFile& file : written) file.sync_and_rename();
    for (const TemporaryFile& file : written) fsync_directory(folder_of(file.target()));
}

struct FileWriter::State {
    std::optional<Stream> stream;
    std::optional<TemporaryFile> file;

    explicit State(const fs::path& target) {
        if (is_stream(target)) {
            stream.emplace(target);
        } else {
            file.emplace(target);
        }
    }
};

FileWriter::FileWriter(const fs::path& path) : state_(std::make_unique<State>(target_of(path))) {}
FileWriter::~FileWriter() = default;

void FileWriter::write(std::string_view text) {
    state_->stream ? state_->stream->write(text) : state_->file->write(text);
}

void FileWriter::close() {
    if (!state_->file) return;
    state_->file->sync_and_rename();
    fsync_directory(folder_of(state_->file->target()));
}

void copy_to_new_file(const fs::path& source, const fs::path& target) {
    Descriptor file(target, O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (!file.valid()) throw create_error("create", target, errno);
    try {
        read_blocks(source, [&](std::string_view block) {
            if (!write_all(file, block)) throw create_error("write", target, errno);
        });
        if (!file.close()) throw create_error("write", target, errno);
    } catch (...) {
        ::unlink(target.c_str());
        throw;
    }
}

void fsync_path(const fs::path& path) {
    Descriptor file(path, O_RDONLY);
    if (!file.valid() || ::fsync(file.number()) != 0 || !file.close()) {
        throw create_error("sync", path, errno);
    }
}

void fsync_directory(const fs::path& path) {
    const Descriptor folder(path, O_RDONLY | O_DIRECTORY);
    // Some file systems cannot sync a folder and say so with EINVAL: there is nothing to wait for.
    if (!folder.valid() || (::fsync(folder.number()) != 0 && errno != EINVAL)) {
        throw create_error("sync", path, errno);
    }
}

CreateError create_error(std::string_view action, const fs::path& path, int error_number) {
    return CreateError(fmt::format("cannot {} {}: {}; {}", action, path.string(),
                                   reason_of(error_number), advice_for(error_number)));
}

}  // namespace kinetome
