#include "kinetome/run/workspace.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "kinetome/run/checkpoint.h"

using namespace kinetome;
namespace fs = std::filesystem;

namespace {

/// A folder of its own for each test, removed at its end.
struct TestFolder {
    TestFolder()
        : path(fs::temp_directory_path() / ("kinetome-run-test-" + std::to_string(getpid()))) {
        fs::remove_all(path);
        fs::create_directories(path);
    }
    ~TestFolder() { fs::remove_all(path); }
    fs::path path;
};

StageKey key_of(const std::string& value) {
    return StageKey().add("option x", value);
}

Receipt make_artifact(const Workspace& workspace, const std::string& name, const StageKey& key) {
    ArtifactWriter file(workspace.folder() / name, {.stage = "frames", .key = key.digest()});
    const std::vector<float> values = {1, 2, 3};
    file.write<float>({.path = "/x", .units = "cm", .description = "x"}, values);
    Receipt receipt;
    receipt.stage = "frames";
    receipt.key = key;
    receipt.file = file.close();
    return receipt;
}

}  // namespace

TEST_CASE("finished work is found by its key and by no other", "[workspace]") {
    const TestFolder folder;
    VerifiedFiles verified;
    Workspace workspace(StoreDirectory::open_or_create(folder.path / "s"), nullptr, verified);
    CHECK_FALSE(workspace.find("a.h5", key_of("1")));
    CHECK(workspace.why_missing("a.h5", key_of("1")) == "is new");
    workspace.commit(make_artifact(workspace, "a.h5", key_of("1")));
    REQUIRE(workspace.find("a.h5", key_of("1")));
    CHECK(workspace.open(*workspace.find("a.h5", key_of("1"))).read<float>("/x").size() == 3);
    CHECK_FALSE(workspace.find("a.h5", key_of("2")));
    CHECK(workspace.why_missing("a.h5", key_of("2")) == "option x was 1, is 2");
}

TEST_CASE("an artifact without its receipt is not finished: the kill came between them",
          "[workspace]") {
    const TestFolder folder;
    VerifiedFiles verified;
    Workspace workspace(StoreDirectory::open_or_create(folder.path / "s"), nullptr, verified);
    make_artifact(workspace, "a.h5", key_of("1"));
    CHECK_FALSE(workspace.find("a.h5", key_of("1")));
}

TEST_CASE("work whose file or receipt was damaged is done again", "[workspace]") {
    const TestFolder folder;
    const StoreDirectory store = StoreDirectory::open_or_create(folder.path / "s");
    {
        VerifiedFiles verified;
        Workspace workspace(store, nullptr, verified);
        workspace.commit(make_artifact(workspace, "a.h5", key_of("1")));
        workspace.commit(make_artifact(workspace, "b.h5", key_of("1")));
    }
    {
        std::fstream file(folder.path / "s/scratch/run/a.h5", std::ios::in | std::ios::out);
        file.seekp(600);
        file.put('\x55');
    }
    std::ofstream(folder.path / "s/scratch/run/b.h5.receipt.json") << "{";
    VerifiedFiles verified;
    Workspace workspace(store, nullptr, verified);
    CHECK_FALSE(workspace.find("a.h5", key_of("1")));
    CHECK(workspace.why_missing("a.h5", key_of("1")).find("damaged") != std::string::npos);
    CHECK_FALSE(workspace.find("b.h5", key_of("1")));
}

TEST_CASE("a checkpoint gives back what was put, and nothing when it is damaged or cut",
          "[checkpoint]") {
    const TestFolder folder;
    const fs::path path = folder.path / "checkpoint";
    CHECK_FALSE(load_checkpoint(path));
    const std::string bytes("seven\0eight", 11);
    save_checkpoint(path, bytes);
    CHECK(load_checkpoint(path) == bytes);

    std::ifstream in(path, std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(in)), {});
    for (size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 1);
        std::ofstream(path, std::ios::binary) << damaged;
        CHECK_FALSE(load_checkpoint(path));
        std::ofstream(path, std::ios::binary) << whole.substr(0, i);
        CHECK_FALSE(load_checkpoint(path));
    }
}
