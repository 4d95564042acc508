// What becomes of output that has nowhere to go, and of commands that only read.
#include <fcntl.h>
#include <sys/stat.h>

#include "program.h"
#include "support/temporary_folder.h"
#include "takes.h"

namespace {

constexpr int cannot_create = 73, io = 74;

/// A small store with letters and primitives.
struct SmallStore {
    TemporaryFolder folder;
    std::string path = (folder / "store").string();
    SmallStore() {
        generate_corpus(folder / "takes", 6000, 1);
        require_program(reindex(folder / "takes", path,
                                {"--only",
                                 "frames,features,pose_clusters,motion_strings,neighbors,"
                                 "segments,primitives"}));
    }
};

CommandResult through_shell(const std::string& line, const std::string& store) {
    return run({.words = {"bash", "-o", "pipefail", "-c", line, KINETOME_PROGRAM, store}});
}

}  // namespace

TEST_CASE("a table that does not fit on a disk is told, however long it is", "[output]") {
    const SmallStore store;
    for (const std::string what : {"letters", "primitives", "clips"}) {
        const CommandResult lost =
            through_shell("\"$0\" export \"$1\" " + what + " > /dev/full", store.path);
        CHECK(lost.exit_code == io);
        CHECK(contains(lost.errors, "standard output: cannot write"));
    }
    const CommandResult full = run_program({"export", store.path, "letters", "-o", "/dev/full"});
    CHECK(full.exit_code == cannot_create);
    CHECK(contains(full.errors, "disk full"));
    CHECK(fs::is_character_file("/dev/full"));
}

TEST_CASE("a reader of standard output that has seen enough is no error", "[output]") {
    const SmallStore store;
    for (const std::string command : {"export \"$1\" neighbors", "verify \"$1\" --digest"}) {
        const CommandResult seen = through_shell("\"$0\" " + command + " | head -1", store.path);
        INFO(seen.errors);
        CHECK(seen.exit_code == 0);
        CHECK(seen.errors.empty());
    }
}

TEST_CASE("a command that only reads ends at once when asked to stop", "[output]") {
    const SmallStore store;
    const std::string labels = (store.folder / "labels").string();
    REQUIRE(::mkfifo(labels.c_str(), 0600) == 0);
    Process label(program({"label", store.path, "--from", labels}));
    int waiting = -1;  // until the command reads what is never written
    wait_until([&] { return (waiting = ::open(labels.c_str(), O_WRONLY | O_NONBLOCK)) >= 0; });
    label.signal(SIGTERM);
    CHECK(label.wait().signal == SIGTERM);
    ::close(waiting);
}
