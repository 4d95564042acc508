#include "kinetome/store/free_space.h"

#include <sys/mount.h>

#include <catch2/catch.hpp>

#include "support/temporary_folder.h"

using namespace kinetome;
namespace fs = std::filesystem;

TEST_CASE("free space is that of the file system, also for a folder that is not there yet") {
    const TemporaryFolder folder;
    // Others write to this file system: asked until it had the same before and after.
    FreeSpace here;
    uint64_t before = 0, after = 1;
    for (int turn = 0; turn < 10'000 && before != after; ++turn) {
        before = fs::space(folder.path()).available;
        here = free_space(folder.path());
        after = fs::space(folder.path()).available;
    }
    CHECK(here.bytes > 0);
    CHECK(here.bytes == after);
    CHECK(free_space(folder / "not" / "yet").bytes > 0);
    CHECK(free_space("relative/not/yet").bytes > 0);
    if (fs::exists("/proc/self/mem")) CHECK(free_space("/proc").bytes == 0);
}

TEST_CASE("inodes that are left are counted, not those that there are") {
    const TemporaryFolder folder;
    if (::mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=1m,nr_inodes=10") != 0) {
        WARN("SKIPPED: no right to mount a small disk");
        return;
    }
    const FreeSpace before = free_space(folder.path());
    folder.write("one", "");
    const FreeSpace after = free_space(folder.path());
    ::umount2(folder.path().c_str(), MNT_DETACH);
    REQUIRE(before.inodes);
    REQUIRE(after.inodes);
    CHECK(*before.inodes < 10);
    CHECK(*after.inodes == *before.inodes - 1);
}
