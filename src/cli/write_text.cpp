#include "write_text.h"

#include <cstdio>

#include "kinetome/base/file.h"

namespace kinetome::cli {

void write_text(const std::filesystem::path& output, std::string_view text) {
    if (output.empty()) {
        std::fwrite(text.data(), 1, text.size(), stdout);
    } else {
        write_file_atomically(output, text);
    }
}

}  // namespace kinetome::cli
