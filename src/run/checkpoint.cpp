#include "kinetome/run/checkpoint.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "kinetome/base/digest.h"
#include "kinetome/base/file.h"

namespace kinetome {
namespace fs = std::filesystem;
namespace {

constexpr size_t hash_digits = 32;

}  // namespace

void CheckpointWriter::save(const fs::path& path) const {
    fs::path temporary = path;
    temporary += ".writing-checkpoint";
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file << digest_of(bytes_).hex() << bytes_;
    file.close();
    if (!file) throw create_error("write", temporary, errno);
    std::error_code error;
    fs::rename(temporary, path, error);
    if (error) throw create_error("replace", path, error.value());
}

std::optional<CheckpointReader> CheckpointReader::open(const fs::path& path) {
    if (!fs::exists(path)) return std::nullopt;
    const std::string whole = read_file(path);
    if (whole.size() < hash_digits) return std::nullopt;
    CheckpointReader reader;
    reader.bytes_ = whole.substr(hash_digits);
    if (digest_of(reader.bytes_).hex() != whole.substr(0, hash_digits)) return std::nullopt;
    return reader;
}

void CheckpointReader::take(void* data, size_t size) {
    if (size > bytes_.size() - at_) throw StoreError("checkpoint is too short");
    std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
}

}  // namespace kinetome
