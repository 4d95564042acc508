#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <set>
#include <thread>

#include "child_process.h"
#include "kinetome/base/error.h"
#include "kinetome/base/random.h"
#include "kinetome/store/store_directory.h"
#include "no_links.h"
#include "store_example.h"
#include "support/temporary_folder.h"

using namespace kinetome;
using namespace store_example;
using Catch::Contains;

namespace {

/// A folder on another file system than the temporary folders; empty when there is none.
fs::path other_file_system(const fs::path& here) {
    struct stat one {
    }, other{};
    const fs::path shared = "/dev/shm";
    if (::stat(here.c_str(), &one) != 0 || ::stat(shared.c_str(), &other) != 0) return {};
    return one.st_dev == other.st_dev ? fs::path() : shared;
}

}  // namespace

TEST_CASE("a published generation is whole, current, and leaves its sources where they were") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    const std::string id = publish(store, "a");
    CHECK(store.current() == id);
    CHECK(fault_in(store.generation_folder(id)) == "");
    CHECK(fs::read_symlink(folder / "current") == fs::path("generations") / id);
    // A kill after publishing, before the scratch folder is removed, must find the work again.
    CHECK(names_in(store.run_folder()).size() == 3);
    CHECK(fs::hard_link_count(store.run_folder() / "bundles.h5") == 2);
    CHECK(names_in(folder.path()) == std::vector<std::string>{"current", "generations",
                                                              "kinetome_store.json", "locks",
                                                              "scratch"});
}

TEST_CASE("ids tell the time and the order of publishing, also within one second") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    std::vector<std::string> ids;
    for (int i = 0; i < 5; ++i) ids.push_back(publish(store, "the same"));
    CHECK(std::set<std::string>(ids.begin(), ids.end()).size() == 5);
    CHECK(store.generations() == ids);
    CHECK(std::is_sorted(ids.begin(), ids.end()));
    CHECK(ids[0].substr(16) == ids[1].substr(16));
    CHECK(publish(store, "another").substr(16) != ids[0].substr(16));
    // A clock that was ahead: what follows is later all the same.
    const std::string future = "29991231T235959Z-0000";
    fs::create_directory(store.generation_folder(future));
    CHECK(publish(store, "a").substr(0, 16) == "30000101T000000Z");
}

TEST_CASE("with --copy no file is shared, and where links are refused it is copied") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    const std::string copied = publish(store, "a", true);
    CHECK(fault_in(store.generation_folder(copied)) == "");
    CHECK(fs::hard_link_count(store.generation_folder(copied) / "bundles.h5") == 1);

    const ChildResult child = run_in_child([&]() -> std::string {
        if (!refuse_links()) return "SKIPPED";
        const std::string id = publish(store, "b");
        return fault_in(store.generation_folder(id));
    });
    if (child.output == "SKIPPED") {
        WARN("SKIPPED: no system call filter can be installed here");
    } else {
        CHECK(child.output == "");
        CHECK(fs::hard_link_count(store.generation_folder(*store.current()) / "bundles.h5") == 1);
    }
}

TEST_CASE("files from another file system are copied") {
    const TemporaryFolder folder;
    const fs::path elsewhere = other_file_system(folder.path());
    if (elsewhere.empty()) {
        WARN("SKIPPED: there is no second file system");
        return;
    }
    const fs::path source = elsewhere / ("kinetome-publish-test-" + std::to_string(::getpid()));
    write_file_atomically(source, "far away");
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    const std::string id = store.publish({{"a.h5", source}}, {}, false);
    fs::remove(source);
    CHECK(read_file(store.generation_folder(id) / "a.h5") == "far away");
}

TEST_CASE("what cannot be published whole is not published at all") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    const std::string good = publish(store, "a");
    CHECK_THROWS_AS(store.publish({{"a.h5", folder / "none"}}, {}, false), StoreError);
    CHECK_THROWS_AS(store.publish({{"a.h5", folder.path()}}, {}, true), StoreError);
    CHECK_THROWS_AS(store.publish({}, {{"no/such/folder", ""}}, false), CreateError);
    CHECK(store.current() == good);
    CHECK(store.generations() == std::vector<std::string>{good});
    CHECK(names_in(folder / "generations").size() == 1);
}

TEST_CASE("a full disk while publishing leaves the store as it was") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    const std::string good = publish(store, std::string(5000, 'a'));
    const ChildResult child = run_in_child([&]() -> std::string {
        ::signal(SIGXFSZ, SIG_IGN);
        const rlimit small{4096, 4096};
        ::setrlimit(RLIMIT_FSIZE, &small);
        std::vector<StoreDirectory::File> files{{"a.h5", store.run_folder() / "bundles.h5"}};
        for (const bool copy : {false, true}) {
            const std::string text(copy ? 10 : 5000, 'x');
            try {
                store.publish(files, {{"list.txt", text}}, copy);
                return "published";
            } catch (const CreateError&) {
            }
        }
        return "";
    });
    CHECK(child.output == "");
    CHECK(store.current() == good);
    CHECK(names_in(folder / "generations") == std::vector<std::string>{good});
}

TEST_CASE("a writer killed at any moment leaves current whole, and the next one clears up") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    const auto start = std::chrono::steady_clock::now();
    std::set<std::string> seen{publish(store, "the first")};
    const std::chrono::duration<double, std::micro> needed =
        std::chrono::steady_clock::now() - start;
    RandomStream random(7, "kill -9 while publishing");
    // How long a child needs to publish differs between machines and moments: later ones get more
    // time, until enough of them have published something.
    constexpr size_t enough = 6;
    for (int kill = 0; kill < 30 || (seen.size() < enough && kill < 300); ++kill) {
        {
            ChildProcess writer([&] {
                const StoreLock lock = store.lock_writer();
                for (int i = 0;; ++i) {
                    publish(store, std::to_string(kill) + " " + std::to_string(i), i % 2 == 1);
                    store.remove_old(3);
                }
            });
            ::usleep(static_cast<useconds_t>(random.uniform(0, 3 + kill / 10) * needed.count()));
        }
        const auto current = store.current();
        REQUIRE(current);
        CHECK(fault_in(store.generation_folder(*current)) == "");
        for (const std::string& id : store.generations()) {
            INFO(id);
            CHECK(fault_in(store.generation_folder(id)) == "");
        }
        seen.insert(*current);
    }
    CHECK(seen.size() >= enough);  // else the child was always killed too early to test anything
    const StoreLock lock = store.lock_writer();
    for (const std::string& name : names_in(folder / "generations")) CHECK(name.front() != '.');
    for (const std::string& name : names_in(folder.path())) CHECK(name.front() != '.');
    CHECK(names_in(folder / "locks") == std::vector<std::string>{"leases", "slices", "writer"});
}

TEST_CASE("readers find whole generations while others are published and removed") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    publish(store, "the first");
    ChildProcess writer([&] {
        const StoreLock lock = store.lock_writer();
        for (int i = 0;; ++i) {
            publish(store, std::to_string(i));
            store.remove_old(1);
        }
    });
    int read = 0, moved_on = 0;
    std::set<std::string> seen;
    while (seen.size() < 15 && read + moved_on < 20'000) {
        const std::string id = *store.current();
        try {
            const StoreLock lease = store.lease(id);
            REQUIRE(lease.held());
            ::usleep(2000);
            CHECK(fault_in(store.generation_folder(id)) == "");
            seen.insert(id);
            ++read;
        } catch (const StoreError&) {
            ++moved_on;  // between finding it and leasing it: the command is run again
        }
    }
    CHECK(seen.size() == 15);
}
