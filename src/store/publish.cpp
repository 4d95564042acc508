#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <system_error>

#include "generation_id.h"
#include "kinetome/base/digest.h"
#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"
#include "kinetome/store/store_directory.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

/// A folder that is removed again unless it was published.
class NewFolder {
  public:
    explicit NewFolder(fs::path path) : path_(std::move(path)) {
        std::error_code error;
        fs::create_directory(path_, error);
        if (error) throw create_error("create", path_, error.value());
    }
    ~NewFolder() {
        std::error_code ignored;  // the next writer tries again
        if (!published_) fs::remove_all(path_, ignored);
    }
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;

    const fs::path& path() const { return path_; }
    void rename(const fs::path& target) {
        if (::rename(path_.c_str(), target.c_str()) != 0) {
            throw create_error("create", target, errno);
        }
        path_ = target;
    }
    void keep() { published_ = true; }

  private:
    fs::path path_;
    bool published_ = false;
};

/// Whether a link was refused for what the file system or its borders are, so that a copy may do.
bool links_are_refused(int error_number) {
    constexpr std::array refusals{EXDEV, EPERM, EMLINK, EOPNOTSUPP, ENOSYS};
    return std::find(refusals.begin(), refusals.end(), error_number) != refusals.end();
}

void link_or_copy(const fs::path& source, const fs::path& target, bool copy) {
    std::error_code error;
    if (!fs::is_regular_file(source, error)) {
        throw StoreError(path_for_message(source.string()) +
                         " is missing: run the same command again to remake it");
    }
    if (copy) return copy_to_new_file(source, target);
    if (::link(source.c_str(), target.c_str()) == 0) return;
    if (!links_are_refused(errno)) throw create_error("create", target, errno);
    copy_to_new_file(source, target);
}

}  // namespace

std::string StoreDirectory::publish(const std::vector<File>& files,
                                    const std::map<std::string, std::string>& texts, bool copy) {
    const std::string id = next_generation_id(files, texts);
    NewFolder folder(generations_folder() / (".new-" + id));
    for (const File& file : files) {
        link_or_copy(file.source, folder.path() / file.name, copy);
        fsync_path(folder.path() / file.name);
    }
    for (const auto& [name, text] : texts) write_file_atomically(folder.path() / name, text);
    fsync_directory(folder.path());
    folder.rename(generation_folder(id));
    fsync_directory(generations_folder());
    switch_current(id);
    folder.keep();
    fsync_directory(path_);
    return id;
}

std::string StoreDirectory::next_generation_id(
    const std::vector<File>& files, const std::map<std::string, std::string>& texts) const {
    Hasher content;
    for (const File& file : files) content.text(file.name);
    for (const auto& [name, text] : texts) content.text(name).text(text);
    const std::vector<std::string> before = generations();
    return generation_id_after(before.empty() ? "" : before.back(), std::time(nullptr),
                               content.finish().low);
}

void StoreDirectory::switch_current(const std::string& id) const {
    const fs::path link = path_ / (".new-current-" + id);
    const fs::path target = fs::path("generations") / id;
    if (::symlink(target.c_str(), link.c_str()) != 0) throw create_error("create", link, errno);
    if (::rename(link.c_str(), (path_ / "current").c_str()) != 0) {
        const int error = errno;
        ::unlink(link.c_str());
        throw create_error("switch", path_ / "current", error);
    }
}

}  // namespace kinetome
