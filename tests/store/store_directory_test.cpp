#include "kinetome/store/store_directory.h"

#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <set>

#include "child_process.h"
#include "kinetome/base/error.h"
#include "store_example.h"
#include "support/temporary_folder.h"

using namespace kinetome;
using namespace store_example;
using Catch::Contains;

namespace {

/// A child that holds what `take` returns until it is killed, at the latest with this object.
class Holder {
  public:
    template <class Take>
    explicit Holder(const Take& take) : ready_(make_pipe()), child_([&] { hold(take); }) {
        ::close(ready_[1]);
        char byte = 0;
        const bool holds = ::read(ready_[0], &byte, 1) == 1;
        ::close(ready_[0]);
        if (!holds) throw std::runtime_error("the child could not take it");
    }
    void kill() {
        child_.kill();
        child_.wait();
    }

  private:
    static std::array<int, 2> make_pipe() {
        std::array<int, 2> ends{};
        if (::pipe(ends.data()) != 0) throw std::runtime_error("cannot make a pipe");
        return ends;
    }
    template <class Take>
    void hold(const Take& take) const {
        const StoreLock lock = take();
        while (::write(ready_[1], "!", 1) == 1) ::pause();
    }

    std::array<int, 2> ready_;
    ChildProcess child_;
};

}  // namespace

TEST_CASE("a store is made where nothing is, and opened again") {
    const TemporaryFolder folder;
    const fs::path path = folder / "deep" / "store";
    CHECK_THROWS_AS(StoreDirectory::open(path), StoreError);
    CHECK_THROWS_WITH(StoreDirectory::open(path), Contains("there is no store " + path.string()));
    const StoreDirectory made = StoreDirectory::open_or_create(path);
    CHECK_FALSE(made.current());
    CHECK(made.generations().empty());
    CHECK(StoreDirectory::open(path).path() == path);
    CHECK(StoreDirectory::open_or_create(path).path() == path);
}

TEST_CASE("a folder of another kind is not scribbled in") {
    const TemporaryFolder folder;
    folder.write("thesis.tex", "years of work");
    CHECK_THROWS_AS(StoreDirectory::open_or_create(folder.path()), CreateError);
    CHECK_THROWS_WITH(StoreDirectory::open_or_create(folder.path()),
                      Contains("is not a Kinetome store"));
    CHECK_THROWS_AS(StoreDirectory::open(folder.path()), StoreError);
    CHECK(names_in(folder.path()) == std::vector<std::string>{"thesis.tex"});
    CHECK_THROWS_AS(StoreDirectory::open_or_create(folder / "thesis.tex"), CreateError);
}

TEST_CASE("labels may wait where the store will be, and so may what a kill left of its mark") {
    const TemporaryFolder folder;
    folder.write("labels.csv", "clip,first,end,label\n");
    folder.write(".kinetome_store.json.writing-1-0", "{");
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    const StoreLock lock = store.lock_writer();
    publish(store, "a");
    CHECK(read_file(folder / "labels.csv") == "clip,first,end,label\n");
    CHECK_FALSE(fs::exists(folder / ".kinetome_store.json.writing-1-0"));
}

TEST_CASE("a store of a newer format, or with a damaged mark, is refused") {
    const TemporaryFolder folder;
    StoreDirectory::open_or_create(folder.path());
    folder.write("kinetome_store.json", R"({"kinetome_format":2})");
    CHECK_THROWS_AS(StoreDirectory::open(folder.path()), StoreError);
    CHECK_THROWS_WITH(StoreDirectory::open_or_create(folder.path()),
                      Contains("newer Kinetome (format 2, this one knows up to 1)"));
    for (const std::string mark : {"", "{", "[]", R"({"kinetome_format":"one"})"}) {
        folder.write("kinetome_store.json", mark);
        CHECK_THROWS_AS(StoreDirectory::open(folder.path()), StoreError);
        CHECK_THROWS_WITH(StoreDirectory::open(folder.path()), Contains("kinetome_store.json"));
    }
}

TEST_CASE("generations are found by id, by its beginning and as current") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    CHECK_THROWS_AS(store.resolve_generation("current"), UsageError);
    const std::string first = publish(store, "a"), second = publish(store, "b");
    fs::create_directory(folder / "generations" / "notes");
    CHECK(store.generations() == std::vector<std::string>{first, second});
    CHECK(store.resolve_generation("current") == second);
    CHECK(store.resolve_generation(first) == first);
    CHECK(store.resolve_generation(first.substr(0, 16)) == first);
    CHECK_THROWS_WITH(store.resolve_generation("2"), Contains("several"));
    CHECK_THROWS_AS(store.resolve_generation(""), UsageError);
    CHECK_THROWS_AS(store.resolve_generation("notes"), UsageError);
    CHECK_THROWS_AS(store.resolve_generation("../.."), UsageError);
}

TEST_CASE("a current that names nothing is an error, not an empty store") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    const std::string id = publish(store, "a");
    fs::remove_all(store.generation_folder(id));
    CHECK_THROWS_AS(store.current(), StoreError);
    fs::remove(folder / "current");
    fs::create_symlink("../elsewhere", folder / "current");
    CHECK_THROWS_AS(store.current(), StoreError);
}

TEST_CASE("a store has one writer, or slices of different names") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    {
        const Holder writer([&] { return store.lock_writer(); });
        CHECK_THROWS_AS(store.lock_writer(), CreateError);
        CHECK_THROWS_AS(store.lock_slice("slice-1-of-2"), CreateError);
    }
    {
        const Holder first([&] { return store.lock_slice("slice-1-of-2"); });
        const Holder second([&] { return store.lock_slice("slice-2-of-2"); });
        CHECK_THROWS_AS(store.lock_slice("slice-1-of-2"), CreateError);
        CHECK_THROWS_WITH(store.lock_writer(), Contains("slice-1-of-2 is held by process"));
        CHECK(store.lock_slice("slice-3-of-3").held());
    }
    // Both were killed: nothing is in the way, and nothing of them is left.
    CHECK(store.lock_writer().held());
    CHECK(names_in(folder / "locks" / "slices").empty());
    CHECK(store.lock_slice("slice-1-of-2").held());
    for (const std::string name : {"", ".", "..", "../writer", "a/b"}) {
        CHECK_THROWS_AS(store.lock_slice(name), UsageError);
    }
}

TEST_CASE("writer and slices never work at the same time, however their locks race") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    const fs::path sliced = folder / "sliced";
    const auto write_alone = [&]() -> std::string {
        for (int attempt = 0; attempt < 300; ++attempt) {
            try {
                const StoreLock lock = store.lock_writer();
                if (fs::exists(sliced)) return "a slice is at work";
            } catch (const CreateError&) {
            }
        }
        return "";
    };
    const auto work_on_slice = [&]() -> std::string {
        for (int attempt = 0; attempt < 300; ++attempt) {
            try {
                const StoreLock lock = store.lock_slice("slice-1-of-1");
                write_file_atomically(sliced, "");
                fs::remove(sliced);
            } catch (const CreateError&) {
            }
        }
        return "";
    };
    AnsweringChild slice(work_on_slice), writer(write_alone);
    CHECK(writer.wait().output == "");
    CHECK(slice.wait().output == "");
}

TEST_CASE("old generations are removed, but never the current or a leased one") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    std::vector<std::string> ids;
    for (int i = 0; i < 6; ++i) ids.push_back(publish(store, std::to_string(i)));
    CHECK_THROWS_AS(store.remove_old(0), UsageError);
    {
        Holder reader([&] { return store.lease(ids[1]); });
        // The user went back to an old generation by hand.
        fs::remove(folder / "current");
        fs::create_symlink(fs::path("generations") / ids[2], folder / "current");
        CHECK(store.leased(ids[1]));
        CHECK_FALSE(store.leased(ids[0]));
        CHECK(store.remove_old(2) == std::vector<std::string>{ids[0], ids[3]});
        CHECK(store.generations() == std::vector<std::string>{ids[1], ids[2], ids[4], ids[5]});
        CHECK(store.remove_old(2).empty());
    }
    // The reader was killed: its lease counts no more, and is cleared away.
    CHECK(store.remove_old(2) == std::vector<std::string>{ids[1]});
    CHECK(names_in(folder / "locks" / "leases").empty());
    CHECK(store.remove_old(1) == std::vector<std::string>{ids[4]});
    for (const std::string& id : store.generations()) {
        CHECK(fault_in(store.generation_folder(id)) == "");
    }
}

TEST_CASE("files shared by a removed generation stay whole in the others") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    const std::string first = publish(store, "a");
    const fs::path list = store.generation_folder(first) / "list.txt";
    std::vector<StoreDirectory::File> same;
    for (const std::string name : {"frames-0.h5", "frames-1.h5", "bundles.h5"}) {
        same.push_back({name, store.generation_folder(first) / name});
    }
    const std::string second = store.publish(same, {{"list.txt", read_file(list)}}, false);
    CHECK(fs::hard_link_count(store.generation_folder(second) / "bundles.h5") == 3);
    CHECK(store.remove_old(1) == std::vector<std::string>{first});
    CHECK(fault_in(store.generation_folder(second)) == "");
}

TEST_CASE("a reader may have several leases, and a generation that is gone has none") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    const std::string id = publish(store, "a");
    {
        const StoreLock first = store.lease(id);
        {
            const StoreLock second = store.lease(id);
            CHECK(second.held());
        }
        CHECK(store.leased(id));
    }
    CHECK_FALSE(store.leased(id));
    CHECK_THROWS_AS(store.lease("20200101T000000Z-0000"), StoreError);
    CHECK(names_in(folder / "locks" / "leases").empty());
}

TEST_CASE("a generation whose removal has begun cannot be leased") {
    const TemporaryFolder folder;
    StoreDirectory store = StoreDirectory::open_or_create(folder.path());
    const std::string id = publish(store, "a");
    const fs::path removal = folder / "locks" / ("removal." + id);
    Holder remover([&] { return StoreLock::take(removal); });
    CHECK_THROWS_AS(store.lease(id), StoreError);
    CHECK_FALSE(store.leased(id));
    remover.kill();
    CHECK(store.lease(id).held());
}

TEST_CASE("a store that one may only read is read without a lease, and not written to") {
    const TemporaryFolder folder;
    std::string id;
    {
        StoreDirectory store = StoreDirectory::open_or_create(folder / "store");
        id = publish(store, "a");
    }
    // As another user, for whom all is read-only; root would write regardless.
    ::chmod(folder.path().c_str(), 0755);
    const ChildResult child = run_in_child([&]() -> std::string {
        constexpr uid_t nobody = 65534;
        if (::geteuid() == 0 && ::setuid(nobody) != 0) return "SKIPPED";
        if (::geteuid() != nobody)
            fs::permissions(folder / "store" / "locks" / "leases", fs::perms(0555));
        StoreDirectory store = StoreDirectory::open(folder / "store");
        if (store.lease(id).held()) return "a lease was made";
        if (fault_in(store.generation_folder(*store.current())) != "") return "not readable";
        if (::geteuid() != nobody) return "";
        try {
            store.lock_writer();
            return "the writer's lock was made";
        } catch (const CreateError& error) {
            return std::string(error.what()).find("may write to") != std::string::npos
                       ? ""
                       : error.what();
        }
    });
    CHECK(child.output == "");
    fs::permissions(folder / "store" / "locks" / "leases", fs::perms::owner_all);
}
