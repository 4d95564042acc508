#include "kinetome/base/file.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cerrno>
#include <thread>
#include <vector>

#include "support/temporary_folder.h"

using namespace kinetome;
using Catch::Contains;

namespace {

/// While it lives, no file of this process can grow beyond `bytes`: a disk that fills up.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) : handler_(::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &original_);
        const rlimit limited{bytes, original_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limited);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &original_);
        ::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  private:
    rlimit original_{};
    void (*handler_)(int);
};

std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        names.push_back(entry.path().filename().string());
    }
    return names;
}

}  // namespace

TEST_CASE("what was written is read, zero bytes and all") {
    const TemporaryFolder folder;
    std::string text((size_t{3} << 20) + 1, 'x');
    text[5] = '\0';
    write_file_atomically(folder / "file", text);
    CHECK(read_file(folder / "file") == text);
    CHECK(read_source_file(folder / "file") == text);
    write_file_atomically(folder / "file", "");
    CHECK(read_file(folder / "file").empty());
    CHECK(names_in(folder.path()) == std::vector<std::string>{"file"});
}

TEST_CASE("a file of the store that cannot be read is an error of the store, naming the path") {
    const TemporaryFolder folder;
    CHECK_THROWS_AS(read_file(folder / "missing"), StoreError);
    CHECK_THROWS_WITH(read_file(folder / "missing"),
                      Contains("missing") && Contains("No such file"));
    CHECK_THROWS_AS(read_file(folder.path()), StoreError);
}

TEST_CASE("a source file that cannot be read is quarantined, not an error of the store") {
    const TemporaryFolder folder;
    CHECK_THROWS_AS(read_source_file(folder / "missing"), InputError);
    CHECK_THROWS_WITH(read_source_file(folder.path()), Contains("Is a directory"));
}

TEST_CASE("a write that fails half-way keeps the old file and leaves no other") {
    const TemporaryFolder folder;
    const auto path = folder.write("ledger.json", "old");
    {
        const FileSizeLimit limit(1000);
        CHECK_THROWS_AS(write_file_atomically(path, std::string(5000, 'n')), CreateError);
    }
    CHECK(read_file(path) == "old");
    CHECK(names_in(folder.path()) == std::vector<std::string>{"ledger.json"});
}

TEST_CASE("a rename that fails leaves no temporary file") {
    const TemporaryFolder folder;
    folder.write("taken/by a folder", "");
    CHECK_THROWS_WITH(write_file_atomically(folder / "taken", "text"), Contains("cannot replace"));
    CHECK(names_in(folder.path()) == std::vector<std::string>{"taken"});
}

TEST_CASE("of several files none appears where one cannot be written") {
    const TemporaryFolder folder;
    const FileText files[] = {{folder / "motion", "m"}, {folder / "no" / "meter", "e"}};
    CHECK_THROWS_AS(write_files_atomically(files), CreateError);
    CHECK(names_in(folder.path()).empty());
}

TEST_CASE("a pipe or a link that is written to stays what it is") {
    const TemporaryFolder folder;
    const std::filesystem::path pipe = folder / "pipe", link = folder / "link";
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    std::string read;
    std::thread reader([&] { read = read_file(pipe); });
    write_file_atomically(pipe, "through the pipe");
    reader.join();
    CHECK(read == "through the pipe");
    CHECK(std::filesystem::is_fifo(pipe));

    folder.write("linked", "old");
    std::filesystem::create_symlink("linked", link);
    write_file_atomically(link, "new");
    CHECK(std::filesystem::is_symlink(link));
    CHECK(read_file(folder / "linked") == "new");
}

TEST_CASE("writing into a missing folder says which and what to check") {
    const TemporaryFolder folder;
    CHECK_THROWS_WITH(write_file_atomically(folder / "no" / "file", "text"),
                      Contains((folder / "no").string()) && Contains("check that the folder"));
}

TEST_CASE("what a killed process left behind does not stop the next write") {
    const TemporaryFolder folder;
    folder.write(".file.writing-" + std::to_string(::getpid()) + "-0", "left behind");
    write_file_atomically(folder / "file", "text");
    CHECK(read_file(folder / "file") == "text");
}

TEST_CASE("a written file has the permissions of any new file, so that colleagues can read it") {
    const TemporaryFolder folder;
    const mode_t mask = ::umask(0027);
    write_file_atomically(folder / "file", "text");
    ::umask(mask);
    struct stat status {};
    REQUIRE(::stat((folder / "file").c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0640);
}

TEST_CASE("a reader never sees a part of a file, even when several write it") {
    const TemporaryFolder folder;
    const auto path = folder.write("file", std::string(50'000, 'z'));
    std::atomic<bool> done{false};
    std::vector<std::thread> writers;
    for (const char letter : {'a', 'b'}) {
        writers.emplace_back([&path, letter, &done] {
            while (!done) write_file_atomically(path, std::string(50'000, letter));
        });
    }
    bool whole = true;
    for (int i = 0; i < 100; ++i) {
        const std::string text = read_file(path);
        whole = whole && text == std::string(50'000, text.front());
    }
    done = true;
    for (std::thread& writer : writers) writer.join();
    CHECK(whole);
    CHECK(names_in(folder.path()).size() == 1);
}

TEST_CASE("a path relative to the working folder can be written") {
    const TemporaryFolder folder;
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    CHECK_NOTHROW(write_file_atomically("file", "text"));
    std::filesystem::current_path(before);
    CHECK(read_file(folder / "file") == "text");
}

TEST_CASE("a full disk, an exhausted quota and a missing permission say what to do") {
    CHECK_THAT(create_error("write", "/a/b", ENOSPC).what(),
               Contains("/a/b") && Contains("disk full: free space"));
    CHECK_THAT(create_error("write", "/a/b", EDQUOT).what(), Contains("quota exhausted"));
    CHECK_THAT(create_error("write", "/a/b", EACCES).what(), Contains("you may write to"));
    CHECK(create_error("write", "/a/b", EIO).exit_code() == ExitCode::cannot_create);
}

TEST_CASE("syncing what is not there is reported") {
    const TemporaryFolder folder;
    const auto file = folder.write("file", "text");
    CHECK_NOTHROW(fsync_path(file));
    CHECK_NOTHROW(fsync_directory(folder.path()));
    CHECK_THROWS_AS(fsync_path(folder / "missing"), CreateError);
    CHECK_THROWS_AS(fsync_directory(file), CreateError);
}

TEST_CASE("a copy has the same bytes, and never replaces a file") {
    const TemporaryFolder folder;
    const std::string bytes(3'000'000, 'x');
    const auto source = folder.write("source", bytes);
    copy_to_new_file(source, folder / "copy");
    CHECK(read_file(folder / "copy") == bytes);
    CHECK_THROWS_AS(copy_to_new_file(source, folder / "copy"), CreateError);
    CHECK_THROWS_AS(copy_to_new_file(folder / "none", folder / "other"), StoreError);
    CHECK_FALSE(std::filesystem::exists(folder / "other"));
}
