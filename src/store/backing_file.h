// The bytes below an HDF5 file. HDF5 is called from h5.cpp only; it calls back into this file.
//
// Why not HDF5's own driver: 1.10 cannot close a file it failed to write (disk full): its cache
// keeps what it could not flush, H5Fclose fails and the library's end loops. Here a failed write is
// remembered, the rest is dropped, HDF5 closes in peace and the writer reports the error. There is
// no file locking either: files are private until they are published, and immutable afterwards.
#pragma once

#include <cstdint>
#include <filesystem>

namespace kinetome::h5 {

class BackingFile {
  public:
    /// Throws CreateError, naming `shown`, when the file exists or cannot be made.
    static BackingFile create_new(const std::filesystem::path& path,
                                  const std::filesystem::path& shown);
    /// Throws StoreError.
    static BackingFile open_to_read(const std::filesystem::path& path);
    ~BackingFile();
    BackingFile(BackingFile&& other) noexcept;
    BackingFile& operator=(BackingFile&&) = delete;

    uint64_t size() const { return size_; }
    /// Bytes beyond the end read as zeros. False on failure.
    bool read(uint64_t offset, void* data, size_t bytes) const;
    void write(uint64_t offset, const void* data, size_t bytes);
    void resize(uint64_t bytes);
    /// From now on nothing is written any more.
    void discard() { discarded_ = true; }
    void close();

    /// errno of the first call that failed; 0 while all is well.
    int error() const { return error_; }

  private:
    BackingFile(int descriptor, uint64_t size) : descriptor_(descriptor), size_(size) {}
    void fail();

    int descriptor_;
    uint64_t size_;
    int error_ = 0;
    bool discarded_ = false;
};

}  // namespace kinetome::h5
