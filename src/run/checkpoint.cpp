#include "kinetome/run/checkpoint.h"

#include <cerrno>
#include <fstream>

#include "kinetome/base/digest.h"
#include "kinetome/base/file.h"

namespace kinetome {
namespace fs = std::filesystem;
namespace {

constexpr size_t hash_digits = 32;

}  // namespace

void save_checkpoint(const fs::path& path, std::string_view bytes) {
    fs::path temporary = path;
    temporary += ".writing-checkpoint";
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file << digest_of(bytes).hex() << bytes;
    file.close();
    if (!file) throw create_error("write", temporary, errno);
    std::error_code error;
    fs::rename(temporary, path, error);
    if (error) throw create_error("replace", path, error.value());
}

std::optional<std::string> load_checkpoint(const fs::path& path) {
    if (!fs::exists(path)) return std::nullopt;
    const std::string whole = read_file(path);
    if (whole.size() < hash_digits) return std::nullopt;
    std::string bytes = whole.substr(hash_digits);
    if (digest_of(bytes).hex() != whole.substr(0, hash_digits)) return std::nullopt;
    return bytes;
}

}  // namespace kinetome
