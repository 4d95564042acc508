#include "kinetome/store/store_lock.h"

#include <signal.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <thread>

#include "child_process.h"
#include "kinetome/base/error.h"
#include "no_links.h"
#include "support/temporary_folder.h"

using namespace kinetome;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// A lock as another holder would have left it: this process's, with some members changed.
void leave_lock(const fs::path& path, const nlohmann::json& changes) {
    nlohmann::json holder;
    {
        const StoreLock lock = StoreLock::take(path);
        holder = nlohmann::json::parse(fs::read_symlink(path).string());
    }
    holder.update(changes);
    fs::create_symlink(holder.dump(), path);
}

/// Number of a process that has ended.
pid_t ended_process() {
    ChildProcess child([] {});
    child.wait();
    return child.id();
}

}  // namespace

TEST_CASE("a lock excludes other processes and threads while it is held, and names its holder") {
    const TemporaryFolder folder;
    const fs::path path = folder / "writer";
    {
        const StoreLock lock = StoreLock::take(path);
        CHECK(lock.held());
        CHECK_THROWS_AS(StoreLock::take(path), CreateError);
        const ChildResult child = run_in_child([&]() -> std::string {
            try {
                StoreLock::take(path);
                return "taken";
            } catch (const CreateError& error) {
                return error.what();
            }
        });
        CHECK_THAT(child.output, Contains("process " + std::to_string(::getpid()) + " on ") &&
                                     Contains("since 2") && Contains("remove " + path.string()));
        CHECK(live_holder(path));
    }
    CHECK_FALSE(live_holder(path));
    CHECK(fs::is_empty(folder.path()));
    CHECK(StoreLock::take(path).held());
}

TEST_CASE("a lock that was moved is released once, by its last owner") {
    const TemporaryFolder folder;
    StoreLock first = StoreLock::take(folder / "a");
    StoreLock second = std::move(first);
    CHECK_FALSE(first.held());
    CHECK(live_holder(folder / "a"));
    second = StoreLock::take(folder / "b");
    CHECK_FALSE(live_holder(folder / "a"));
    CHECK(live_holder(folder / "b"));
    second.release();
    CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("the end of a forked child does not release its parent's lock") {
    const TemporaryFolder folder;
    const StoreLock lock = StoreLock::take(folder / "writer");
    run_in_child([&] {
        StoreLock inherited = std::move(const_cast<StoreLock&>(lock));
        return std::string();
    });
    CHECK(live_holder(folder / "writer"));
}

TEST_CASE("the lock of a killed process is taken over, also before its parent noticed") {
    const TemporaryFolder folder;
    const fs::path path = folder / "writer";
    ChildProcess child([&] {
        const StoreLock lock = StoreLock::take(path);
        for (;;) ::pause();
    });
    while (!live_holder(path)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    CHECK_THROWS_AS(StoreLock::take(path), CreateError);
    child.kill();
    siginfo_t ended{};
    ::waitid(P_PID, static_cast<id_t>(child.id()), &ended, WEXITED | WNOWAIT);
    CHECK(StoreLock::take(path).held());
    CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("a stale lock is taken over: process ended, number used again, machine started again") {
    const TemporaryFolder folder;
    const fs::path path = folder / "writer";
    for (const nlohmann::json& changes :
         {nlohmann::json{{"process", ended_process()}}, nlohmann::json{{"started", 1}},
          nlohmann::json{{"boot", "an earlier one"}}}) {
        INFO(changes.dump());
        leave_lock(path, changes);
        CHECK_FALSE(live_holder(path));
        CHECK(StoreLock::take(path).held());
        CHECK(fs::is_empty(folder.path()));
    }
}

TEST_CASE("a lock of which nothing is sure is left alone") {
    const TemporaryFolder folder;
    const fs::path path = folder / "writer";
    const pid_t ended = ended_process();
    for (const nlohmann::json& changes :
         {nlohmann::json{{"process", ended}, {"host", "another"}},
          nlohmann::json{{"process", ended}, {"pid_namespace", "another container's"}},
          nlohmann::json{{"process", "not a number"}}}) {
        INFO(changes.dump());
        leave_lock(path, changes);
        CHECK(live_holder(path));
        CHECK_THROWS_AS(StoreLock::take(path), CreateError);
        fs::remove(path);
    }
    folder.write("writer", "a file");
    CHECK_THROWS_AS(StoreLock::take(path), CreateError);
    CHECK(fs::is_regular_file(path));
}

TEST_CASE("the holder is shown without its control characters") {
    const TemporaryFolder folder;
    leave_lock(folder / "writer", {{"host", "evil\x1b[2J"}});
    CHECK_THROWS_WITH(StoreLock::take(folder / "writer"), Contains("evil\\x1b[2J"));
}

TEST_CASE("of many who find a stale lock at once, one at a time holds it") {
    const TemporaryFolder folder;
    const fs::path path = folder / "writer", inside = folder / "inside";
    const pid_t ended = ended_process();
    // A directory is made by one process only: who finds it there is not alone.
    const auto contend = [&]() -> std::string {
        int taken = 0;
        for (int attempt = 0; attempt < 1000; ++attempt) {
            try {
                const StoreLock lock = StoreLock::take(path);
                if (!fs::create_directory(inside)) return "two hold the lock";
                fs::remove(inside);
                ++taken;
                if (attempt % 3 == 0) {
                    // Ends like one that was killed: the lock stays, its holder is gone.
                    auto holder = nlohmann::json::parse(fs::read_symlink(path).string());
                    holder["process"] = ended;
                    const fs::path stale = folder / std::to_string(::getpid());
                    fs::create_symlink(holder.dump(), stale);
                    fs::rename(stale, path);
                }
            } catch (const CreateError&) {
            }
        }
        return taken > 0 ? "" : "never got it";
    };
    std::vector<std::thread> waiting;
    std::vector<ChildResult> results(4);
    for (ChildResult& result : results) {
        waiting.emplace_back([&] { result = run_in_child(contend); });
    }
    for (std::thread& thread : waiting) thread.join();
    for (const ChildResult& result : results) {
        CHECK(result.finished_well());
        CHECK(result.output == "");
    }
}

TEST_CASE("a killed process that was taking a lock over bars nobody") {
    const TemporaryFolder folder;
    const fs::path path = folder / "writer";
    leave_lock(path, {{"process", ended_process()}});
    const auto stale = nlohmann::json::parse(fs::read_symlink(path).string());
    leave_lock(path.string() + ".after-" + stale["nonce"].get<std::string>(),
               {{"process", ended_process()}});
    CHECK(StoreLock::take(path).held());
    CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("a file system without hard links has locks all the same") {
    const TemporaryFolder folder;
    const fs::path path = folder / "writer";
    leave_lock(path, {{"process", ended_process()}});
    const ChildResult child = run_in_child([&]() -> std::string {
        if (!refuse_links()) return "SKIPPED";
        const StoreLock lock = StoreLock::take(path);
        return lock.held() ? "held" : "not held";
    });
    if (child.output == "SKIPPED") {
        WARN("SKIPPED: no system call filter can be installed here");
    } else {
        CHECK(child.output == "held");
    }
}

TEST_CASE("a folder that is missing or may not be written to is an error with advice") {
    const TemporaryFolder folder;
    CHECK_THROWS_AS(StoreLock::take(folder / "none" / "writer"), CreateError);
    CHECK_THROWS_WITH(StoreLock::take(folder / "none" / "writer"),
                      Contains("check that the folder"));
}
