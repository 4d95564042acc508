#include <fcntl.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>

#include "artifact_example.h"
#include "child_process.h"
#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "support/temporary_folder.h"

using namespace kinetome;
using namespace artifact_example;
using Catch::Contains;

namespace {

void flip(const std::filesystem::path& path, int64_t offset, char bits = 1) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(offset);
    char byte = 0;
    file.get(byte);
    file.seekp(offset);
    file.put(static_cast<char>(byte ^ bits));
    file.close();
    REQUIRE(file);
}

size_t files_in(const std::filesystem::path& folder) {
    return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// Writing `all` under a limit of `bytes` for each file fails as it does on a full disk, leaves
/// nothing, and does not keep the process from writing once there is room. Returns "" or what is
/// wrong. Ends the process's HDF5 too, which must neither hang nor crash.
std::string fill_disk(const std::filesystem::path& folder, const std::vector<Data>& all,
                      rlim_t bytes) {
    ::signal(SIGXFSZ, SIG_IGN);
    rlimit original{};
    ::getrlimit(RLIMIT_FSIZE, &original);
    const rlimit small{bytes, original.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
    for (int attempt = 0; attempt < 2; ++attempt) {
        try {
            write(folder / "full.h5", all);
            return "no error was reported";
        } catch (const CreateError& error) {
            if (error.exit_code() != ExitCode::cannot_create) return "wrong exit code";
            if (std::string(error.what()).find((folder / "full.h5").string()) ==
                std::string::npos) {
                return std::string("the file is not named: ") + error.what();
            }
        }
        if (files_in(folder) != 0) return "something was left behind";
    }
    ::setrlimit(RLIMIT_FSIZE, &original);
    const ArtifactRecord record = write(folder / "later.h5", all);
    const ArtifactReader reader(folder / "later.h5", record.hash);
    for (const Data& data : all) {
        if (bytes_of(read(reader, data)) != bytes_of(data)) return "a later file is wrong";
    }
    return "";
}

/// fill_disk at several moments, in processes that end by exit(), so that HDF5's own end runs after
/// the failed writes.
void check_full_disks(const std::vector<Data>& all, int parts) {
    uint64_t whole = 0;
    {
        const TemporaryFolder folder;
        whole = write(folder / "whole.h5", all).bytes;
    }
    std::vector<uint64_t> limits{0, 100, 4096, whole - 1, whole - 3000};
    for (int part = 1; part < parts; ++part) {
        limits.push_back(whole * static_cast<uint64_t>(part) / static_cast<uint64_t>(parts));
    }
    for (const uint64_t limit : limits) {
        INFO("room for " << limit << " of " << whole << " bytes");
        const TemporaryFolder folder;
        const ChildResult child =
            run_in_child([&] { return fill_disk(folder.path(), all, limit); }, ChildEnd::exit);
        CHECK(child.finished_well());
        CHECK(child.output == "");
    }
}

}  // namespace

TEST_CASE(
    "a disk that fills up at any moment is reported, leaves nothing, and harms no later file") {
    check_full_disks(every_type(20'000), 6);
}

TEST_CASE("a disk that fills up while HDF5's own tables are written is reported like any other") {
    // So many datasets that HDF5's cache of descriptions overflows.
    std::vector<Data> many;
    for (int i = 0; i < 500; ++i) {
        many.push_back(
            data<int32_t>("/group " + std::to_string(i / 10) + "/" + std::to_string(i), {}, 3));
        many.back().spec.description = std::string(8000, 'd');
    }
    check_full_disks(many, 3);
}

TEST_CASE("a file system that is full says so, with advice") {
    const TemporaryFolder folder;
    if (::mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=1m") != 0) {
        WARN("SKIPPED: mounting a file system of 1 MiB needs root");
        return;
    }
    std::string message;
    try {
        write(folder / "full.h5", every_type(20'000));
    } catch (const CreateError& error) {
        message = error.what();
    }
    const size_t left = files_in(folder.path());
    const ArtifactRecord record = write(folder / "small.h5", every_type(10));
    ::umount2(folder.path().c_str(), MNT_DETACH);
    CHECK_THAT(message, Contains((folder / "full.h5").string()) && Contains("disk full") &&
                            Contains("run the same command again"));
    CHECK(left == 0);
    CHECK(record.bytes > 0);
}

TEST_CASE("whichever of two disks is full is named, and nothing is left on either") {
    const TemporaryFolder small, large;
    if (::mount("tmpfs", small.path().c_str(), "tmpfs", 0, "size=1m") != 0) {
        WARN("SKIPPED: mounting a file system of 1 MiB needs root");
        return;
    }
    const auto message_of = [&](const TemporaryFolder& place, const TemporaryFolder& scratch) {
        try {
            write(place / "full.h5", every_type(20'000), 0, {Compression::none, scratch.path()});
        } catch (const CreateError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string in_scratch = message_of(large, small), in_place = message_of(small, large);
    const size_t left = files_in(small.path()) + files_in(large.path());
    ::umount2(small.path().c_str(), MNT_DETACH);
    for (const std::string& message : {in_scratch, in_place}) {
        CHECK_THAT(message,
                   Contains(small.path().string()) && Contains("full.h5") && Contains("disk full"));
    }
    CHECK(left == 0);
}

TEST_CASE("any flipped bit of a file is refused before HDF5 sees it, naming the file") {
    const TemporaryFolder folder;
    const auto path = folder / "a.h5";
    const ArtifactRecord record = write(path, every_type(50));
    for (int64_t offset = 0; offset < static_cast<int64_t>(record.bytes); offset += 97) {
        const char bit = static_cast<char>(1 << (offset % 8));
        flip(path, offset, bit);
        INFO("bit " << offset % 8 << " of byte " << offset);
        CHECK_THROWS_AS(ArtifactReader(path, record.hash), StoreError);
        CHECK_THROWS_WITH(ArtifactReader(path, record.hash),
                          Contains(path.string()) && Contains("damaged"));
        flip(path, offset, bit);
    }
    CHECK(ArtifactReader(path, record.hash).rows("/letters") == 50);
}

TEST_CASE("a file that was cut, is missing or is something else is refused") {
    const TemporaryFolder folder;
    const auto path = folder / "a.h5";
    const ArtifactRecord record = write(path, every_type(50));
    std::filesystem::resize_file(path, record.bytes - 1);
    CHECK_THROWS_AS(ArtifactReader(path, record.hash), StoreError);
    CHECK_THROWS_AS(ArtifactReader(folder / "none.h5", record.hash), StoreError);
    const auto text = folder.write("text.h5", "not HDF5");
    CHECK_THROWS_AS(ArtifactReader(text, digest_file(text)), StoreError);
    CHECK_THROWS_WITH(ArtifactReader(text, digest_file(text)), Contains(text.string()));
}

TEST_CASE("a file is hashed once, and again after it was changed") {
    const TemporaryFolder folder;
    const auto path = folder / "a.h5";
    const ArtifactRecord record = write(path, every_type(2000));
    VerifiedFiles verified;
    CHECK(ArtifactReader(path, record.hash, verified).rows("/letters") == 2000);

    // Damage that leaves size and time as they were goes unseen: the file was not hashed again.
    struct stat before {};
    REQUIRE(::stat(path.c_str(), &before) == 0);
    flip(path, static_cast<int64_t>(record.bytes) / 2);
    const std::array<timespec, 2> times{before.st_atim, before.st_mtim};
    REQUIRE(::utimensat(AT_FDCWD, path.c_str(), times.data(), 0) == 0);
    CHECK_NOTHROW(verified.require(path, record.hash));
    // Its time tells of the change.
    const std::array<timespec, 2> later{before.st_atim, {before.st_mtim.tv_sec + 1, 0}};
    REQUIRE(::utimensat(AT_FDCWD, path.c_str(), later.data(), 0) == 0);
    CHECK_THROWS_AS(verified.require(path, record.hash), StoreError);
    // So does another hash to compare with.
    REQUIRE(::utimensat(AT_FDCWD, path.c_str(), times.data(), 0) == 0);
    CHECK_THROWS_AS(verified.require(path, digest_of("another")), StoreError);
}

TEST_CASE("the dataset whose values are damaged is found, and no other") {
    const TemporaryFolder folder;
    const auto path = folder / "a.h5";
    for (const Compression compression : {Compression::none, Compression::gzip}) {
        const std::vector<Data> all = every_type(3000);
        write(path, all, 0, compression);
        CHECK(unreadable_datasets(path).empty());
        if (compression != Compression::none) continue;
        const std::string content = read_file(path);
        for (const Data& data : all) {
            if (data.spec.type == ElementType::text) continue;
            INFO(data.spec.path);
            // The values stand in the file as they stand in memory.
            const size_t at = content.find(bytes_of(data).substr(0, 1000));
            REQUIRE(at != std::string::npos);
            flip(path, static_cast<int64_t>(at) + 333);
            CHECK(unreadable_datasets(path) == std::vector<std::string>{data.spec.path});
            flip(path, static_cast<int64_t>(at) + 333);
        }
    }
}

TEST_CASE("no damage to a file's structure harms the process that looks for it") {
    const TemporaryFolder folder;
    const auto path = folder / "a.h5";
    const ArtifactRecord record = write(path, every_type(5));
    const std::string whole = read_file(path);
    for (size_t offset = 0; offset < record.bytes; offset += 331) {
        std::string damaged = whole;
        // More than a bit: runs of ones and zeros make lengths and addresses run wild.
        std::fill_n(damaged.begin() + static_cast<std::ptrdiff_t>(offset),
                    std::min<size_t>(64, whole.size() - offset), offset % 2 == 0 ? '\xFF' : '\0');
        folder.write("a.h5", damaged);
        CHECK_NOTHROW(unreadable_datasets(path));
    }
    folder.write("a.h5", whole.substr(0, whole.size() / 2));
    CHECK_NOTHROW(unreadable_datasets(path));
    CHECK_THROWS_AS(unreadable_datasets(folder / "none.h5"), StoreError);
}
