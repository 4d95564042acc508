#include "write_text.h"

#include <cerrno>
#include <cstdio>

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

void flush_output() {
    require_output(std::fflush(stdout) == 0);
}

}  // namespace kinetome::cli
