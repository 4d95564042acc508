#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <functional>
#include <mutex>
#include <optional>
#include <system_error>

#include "h5_library.h"
#include "kinetome/store/artifact.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

using Work = std::function<std::string()>;

void write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t put = ::write(descriptor, text.data(), text.size());
        if (put < 0 && errno != EINTR) ::_exit(1);
        if (put > 0) text.remove_prefix(static_cast<size_t>(put));
    }
}

std::string read_all(int descriptor) {
    std::string text;
    std::array<char, 4096> block;
    for (;;) {
        const ssize_t got = ::read(descriptor, block.data(), block.size());
        if (got > 0) text.append(block.data(), static_cast<size_t>(got));
        if (got == 0 || (got < 0 && errno != EINTR)) return text;
    }
}

[[noreturn]] void work_as_child(int answer, rlim_t seconds, const Work& work) {
    const rlimit processor_time{seconds, seconds}, no_core{0, 0};
    ::setrlimit(RLIMIT_CPU, &processor_time);
    ::setrlimit(RLIMIT_CORE, &no_core);
    try {
        write_all(answer, work());
        ::_exit(0);
    } catch (...) {
        ::_exit(1);
    }
}

/// What `work` returns, done by a forked process; nothing when that process failed or died.
std::optional<std::string> result_of_child(rlim_t seconds, const Work& work) {
    std::array<int, 2> ends{};
    pid_t child = -1;
    if (::pipe2(ends.data(), O_CLOEXEC) == 0) {
        // No other thread is inside HDF5 at this moment: the child finds it in order.
        const std::lock_guard lock(h5::library_mutex());
        child = ::fork();
    }
    if (child < 0) throw StoreError("cannot start a process to look at a damaged file");
    if (child == 0) work_as_child(ends[1], seconds, work);
    ::close(ends[1]);
    std::string answer = read_all(ends[0]);
    ::close(ends[0]);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
    return answer;
}

void read_whole(const fs::path& path, const std::string& dataset) {
    const h5::InputFile file(path);
    const h5::Layout& layout = file.layout(dataset);
    int64_t row_bytes =
        layout.type == ElementType::text ? layout.text_width : element_bytes(layout.type);
    for (const int64_t size : layout.row_shape) row_bytes *= size;
    std::vector<char> block(static_cast<size_t>(layout.chunk_rows * row_bytes));
    for (int64_t first = 0; first < *layout.rows; first += layout.chunk_rows) {
        file.read_rows(dataset, first, std::min(layout.chunk_rows, *layout.rows - first),
                       block.data());
    }
}

std::vector<std::string> split_at_zeros(const std::string& text) {
    std::vector<std::string> parts;
    for (size_t first = 0; first < text.size();) {
        parts.emplace_back(text.c_str() + first);
        first += parts.back().size() + 1;
    }
    return parts;
}

}  // namespace

std::vector<std::string> unreadable_datasets(const fs::path& path) {
    // Damage could make HDF5 turn in circles. Any sound file is read at this pace.
    constexpr uint64_t bytes_a_second = 10'000'000;
    std::error_code error;
    const uint64_t bytes = fs::file_size(path, error);
    if (error) throw StoreError("cannot open " + path.string() + ": " + error.message());
    const rlim_t seconds = 60 + bytes / bytes_a_second;
    const auto names = result_of_child(seconds, [&] {
        std::string all;
        for (const std::string& name : h5::InputFile(path).datasets()) all += name + '\0';
        return all;
    });
    std::vector<std::string> unreadable;
    for (const std::string& dataset : split_at_zeros(names.value_or(""))) {
        const auto whole = result_of_child(seconds, [&] {
            read_whole(path, dataset);
            return std::string();
        });
        if (!whole) unreadable.push_back(dataset);
    }
    return unreadable;
}

}  // namespace kinetome
