#include "text_file.h"

#include <cerrno>
#include <utility>

#include "kinetome/base/file.h"

namespace kinetome {
namespace {

constexpr size_t large = 256 * 1024;

}  // namespace

TextFile::TextFile(std::filesystem::path path)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
    if (!file_) throw create_error("create", path_, errno);
    std::setvbuf(file_.get(), nullptr, _IONBF, 0);
    text_.reserve(large + large / 8);
}

void TextFile::write_if_large() {
    if (text_.size() >= large) write();
}

void TextFile::write() {
    if (std::fwrite(text_.data(), 1, text_.size(), file_.get()) != text_.size())
        throw create_error("write", path_, errno);
    text_.clear();
}

void TextFile::close() {
    write();
    if (std::fclose(file_.release()) != 0) throw create_error("write", path_, errno);
}

}  // namespace kinetome
