// A new file that is written as its text is made.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

namespace kinetome {

/// Not waited for on the disk: a generated corpus is made again from its seed sooner than synced.
/// Throws CreateError.
class TextFile {
  public:
    explicit TextFile(std::filesystem::path path);

    /// Text not yet written; append to it.
    std::string& text() { return text_; }
    /// Writes what has gathered, when that is enough to be worth it.
    void write_if_large();
    /// Writes the rest. Without it the file stays incomplete.
    void close();

  private:
    struct Closer {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    void write();

    std::filesystem::path path_;
    std::unique_ptr<std::FILE, Closer> file_;
    std::string text_;
};

}  // namespace kinetome
