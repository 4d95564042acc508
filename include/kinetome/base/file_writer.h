// A file replaced by text that is too long to be held: as write_file_atomically, piece by piece.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>

namespace kinetome {

/// Takes a text, one piece behind the other.
using TakeText = std::function<void(std::string_view)>;

/// Unless it is closed, what was at the path is still there. Throws CreateError.
class FileWriter {
  public:
    explicit FileWriter(const std::filesystem::path& path);
    ~FileWriter();
    FileWriter(const FileWriter&) = delete;
    FileWriter& operator=(const FileWriter&) = delete;

    void write(std::string_view text);
    void close();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kinetome
