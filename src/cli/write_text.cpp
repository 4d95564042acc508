#include "write_text.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"

namespace kinetome::cli {
namespace {

/// By the error that was met last.
void require_output(bool written) {
    if (!written && errno != EPIPE)
        throw StoreError("standard output: cannot write: is its disk full?");
}

}  // namespace

void write_text(const std::filesystem::path& output, std::string_view text) {
    if (output.empty()) {
        require_output(std::fwrite(text.data(), 1, text.size(), stdout) == text.size());
    } else {
        write_file_atomically(output, text);
    }
}

void write_text(const std::filesystem::path& output,
                const std::function<void(const TakeText&)>& write) {
    if (output.empty()) {
        write([](std::string_view text) {
            if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size()) return;
            if (errno == EPIPE) throw std::system_error(EPIPE, std::generic_category());
            require_output(false);
        });
        return;
    }
    FileWriter file(output);
    write([&](std::string_view text) { file.write(text); });
    file.close();
}

void flush_output() {
    require_output(std::fflush(stdout) == 0);
}

}  // namespace kinetome::cli
