#include "kinetome/store/store_lock.h"

#include <signal.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <list>
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

/// An environment variable that is set while the object lives.
class Variable {
  public:
    Variable(const char* name, const std::string& value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before;
        ::setenv(name, value.c_str(), 1);
    }
    ~Variable() {
        if (before_) {
            ::setenv(name_, before_->c_str(), 1);
        } else {
            ::unsetenv(name_);
        }
    }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

  private:
    const char* name_;
    std::optional<std::string> before_;
};

/// A process of job 12 that was restarted twice, on a cluster whose squeue is a script.
class InsideJob {
  public:
    explicit InsideJob(const std::string& squeue) {
        const fs::path program = folder_.write("squeue", "#!/bin/sh\n" + squeue);
        fs::permissions(program, fs::perms::owner_exec, fs::perm_options::add);
    }
    /// Leaves the job for a machine of a cluster, where jobs are submitted.
    void leave_job(const std::string& cluster) {
        const fs::path program = folder_.write(
            "scontrol",
            "#!/bin/sh\necho 'BootTime   = now'\necho 'ClusterName   = " + cluster + "'");
        fs::permissions(program, fs::perms::owner_exec, fs::perm_options::add);
        outside_.emplace("SLURM_JOB_ID", "");
    }
    std::string asked() const {
        std::ifstream file(folder_ / "asked");
        std::string line;
        std::getline(file, line);
        return line;
    }

  private:
    TemporaryFolder folder_;
    Variable path_{"PATH", folder_.path().string() + ":" + std::getenv("PATH")};
    Variable asked_{"ASKED", (folder_ / "asked").string()};
    Variable cluster_{"SLURM_CLUSTER_NAME", "alpha"};
    Variable job_{"SLURM_JOB_ID", "12"};
    Variable restarts_{"SLURM_RESTART_COUNT", "2"};
    std::optional<Variable> outside_;
};

/// A lock of a process on another machine.
void leave_distant_lock(const fs::path& path, const nlohmann::json& job) {
    leave_lock(path, {{"host", "another"}, {"slurm", job}});
}

nlohmann::json job(uint64_t id, int restarts = 0, uid_t user = ::geteuid()) {
    return {{"cluster", "alpha"}, {"job", id}, {"restarts", restarts}, {"user", user}};
}

const std::string forgotten = "echo slurm_load_jobs error: Invalid job id specified >&2; exit 1";

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

TEST_CASE("a job that Slurm began anew on another machine takes over the lock it had before") {
    const TemporaryFolder folder;
    const fs::path path = folder / "writer";
    const InsideJob inside("echo 12 RUNNING");
    leave_distant_lock(path, job(12, 1));
    CHECK_FALSE(live_holder(path));
    CHECK(StoreLock::take(path).held());
    // Another process of this very start of the job, or of a later one.
    for (const int restarts : {2, 3}) {
        leave_distant_lock(path, job(12, restarts));
        CHECK_THROWS_WITH(StoreLock::take(path), Contains("on another (Slurm job 12) since"));
        fs::remove(path);
    }
}

TEST_CASE("the lock of a job on another machine is taken over once Slurm says that it is over") {
    const TemporaryFolder folder;
    const fs::path path = folder / "writer";
    const std::string prefix = "echo \"$@\" >$ASKED\n";
    for (const std::string& squeue :
         {std::string("echo 45 CANCELLED"), std::string("echo 46 RUNNING; echo 45 NODE_FAIL"),
          forgotten}) {
        CAPTURE(squeue);
        const InsideJob inside(prefix + squeue);
        leave_distant_lock(path, job(45));
        CHECK(StoreLock::take(path).held());
        CHECK_THAT(inside.asked(), Contains("--jobs=45 "));
    }
}

TEST_CASE("the lock of a job on another machine is left alone while there is any doubt") {
    const TemporaryFolder folder;
    const fs::path path = folder / "writer";
    const auto left_alone = [&](const std::string& squeue, const nlohmann::json& holder) {
        CAPTURE(squeue, holder.dump());
        const InsideJob inside(squeue);
        leave_distant_lock(path, holder);
        CHECK(live_holder(path));
        fs::remove(path);
    };
    for (const char* squeue :
         {"echo 45 RUNNING", "echo 45 COMPLETING", "echo 45 PENDING", "echo 46 COMPLETED", "true",
          "echo 45 COMPLETED; exit 1", "echo Unable to contact slurm controller >&2; exit 1",
          "echo 45 COMPLETED; echo 45 PENDING", "exit 127"}) {
        left_alone(squeue, job(45));
    }
    left_alone(forgotten, job(45, 0, ::geteuid() + 1));
    const std::string over = "echo 45 COMPLETED";
    nlohmann::json elsewhere = job(45);
    elsewhere["cluster"] = "beta";
    left_alone(over, elsewhere);
    nlohmann::json hostile = job(45);
    hostile["job"] = "45; touch x";
    left_alone(over, hostile);
    // Nor where another cluster's jobs are submitted, or none's.
    for (const std::string cluster : {"beta", ""}) {
        InsideJob slurm(over);
        slurm.leave_job(cluster);
        leave_distant_lock(path, job(45));
        CHECK(live_holder(path));
        fs::remove(path);
    }
}

TEST_CASE("where jobs are submitted, the lock of a job that is over is given up as well") {
    const TemporaryFolder folder;
    const fs::path path = folder / "writer";
    for (const auto& [squeue, over] :
         {std::pair{"echo 45 FAILED", true}, {"echo 45 RUNNING", false}}) {
        InsideJob slurm(squeue);
        slurm.leave_job("alpha");
        leave_distant_lock(path, job(45));
        CHECK(live_holder(path).has_value() == !over);
        fs::remove(path);
    }
}

TEST_CASE("on the same machine the process decides, whatever Slurm says of its job") {
    const TemporaryFolder folder;
    const fs::path path = folder / "writer";
    const InsideJob inside("echo 45 COMPLETED");
    const nlohmann::json over = {{"slurm", job(45)}};
    leave_lock(path, over);
    CHECK(live_holder(path));
    fs::remove(path);
    leave_lock(path, {{"process", ended_process()}, {"slurm", job(12, 2)}});
    CHECK_FALSE(live_holder(path));
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
    std::list<AnsweringChild> children;
    for (int i = 0; i < 4; ++i) children.emplace_back(contend);
    for (AnsweringChild& child : children) {
        const ChildResult result = child.wait();
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
