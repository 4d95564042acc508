// Disks that are full, stores that are damaged, closed, newer or in use: nothing half-made is seen,
// and the message tells what to do (design §4, §8).
#include <sys/mount.h>

#include <random>

#include "small_corpus.h"
#include "store_on_disk.h"

namespace {

constexpr int cannot_create = 73, damaged = 74;

/// A small disk of its own, for as long as it lives; not `mounted` without root's powers.
class SmallDisk {
  public:
    SmallDisk(fs::path path, const std::string& size) : path_(std::move(path)) {
        fs::create_directory(path_);
        mounted_ = ::mount("tmpfs", path_.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
    }
    ~SmallDisk() {
        if (mounted_) ::umount2(path_.c_str(), MNT_DETACH);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;
    bool mounted() const { return mounted_; }

  private:
    fs::path path_;
    bool mounted_ = false;
};

/// Nothing can be written to the disk of `ballast` until it is removed.
void fill_disk(const fs::path& ballast) {
    std::ofstream file(ballast, std::ios::binary);
    const std::string block(4096, 'x');
    while (file.write(block.data(), static_cast<std::streamsize>(block.size())).flush()) {
    }
}

bool holds(const fs::path& folder, const std::string& beginning) {
    std::error_code gone;
    for (fs::directory_iterator entry(folder, gone), end; !gone && entry != end;
         entry.increment(gone)) {
        if (entry->path().filename().string().starts_with(beginning)) return true;
    }
    return false;
}

/// After a run that failed: `current` and all that readers see is as before.
void require_untouched(const StoreOnDisk& store, const std::optional<std::string>& current,
                       const std::string& digests) {
    CHECK(store.current() == current);
    CHECK(store.generations().size() == (current ? 1 : 0));
    if (current) CHECK(store.digests() == digests);
}

void flip_bit(const fs::path& file, size_t bit) {
    std::string bytes = text_of(file);
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    write_text(file, bytes);
}

fs::path writer_lock(const StoreOnDisk& store) {
    return store.path() / "locks" / "writer";
}

}  // namespace

TEST_CASE("a disk that is full leaves the store as it was", "[store fault]") {
    SmallCorpus corpus;
    generate_corpus(corpus.path(), 12'000, 1);
    const SmallDisk disk(corpus.folder() / "disk", "64m");
    if (!disk.mounted()) {
        WARN("SKIPPED: no right to mount a small disk");
        return;
    }
    const StoreOnDisk store(corpus.folder() / "disk" / "store");
    require_program(reindex(corpus.path(), store.path(), {"--max-iterations", "2"}));
    const auto current = store.current();
    const std::string digests = store.digests();
    const auto again =
        reindex(corpus.path(), store.path(),
                {"--clusters", "400", "--velocity-reach", "0.03", "--min-gain", "0"});

    // Another file fails to be written each time: the disk fills up when the run has come so far.
    const fs::path ballast = corpus.folder() / "disk" / "ballast";
    for (const std::string reached : {".features-", "features-last.h5.receipt", "checkpoint-"}) {
        INFO(reached);
        Process run(program(again));
        wait_until([&] { return run.ended() || holds(store.run_folder(), reached); });
        fill_disk(ballast);
        const CommandResult full = run.wait();
        INFO(full.errors);
        CHECK(full.exit_code == cannot_create);
        CHECK(contains(full.errors, "disk full: free space there"));
        fs::remove(ballast);
        require_untouched(store, current, digests);
        fs::remove_all(store.run_folder());
    }

    // A corpus that has no room from the start is refused before any of it is read.
    const auto room = fs::space(store.path()).available;
    write_text(ballast, std::string(room - 1'000'000, 'x'));
    const CommandResult refused = require_program(again, cannot_create);
    CHECK(contains(refused.errors, "this run needs about"));
    CHECK_FALSE(contains(refused.errors, "to be made"));
    require_untouched(store, current, digests);

    fs::remove(ballast);
    require_program(again);
    CHECK(store.current() != current);
}

TEST_CASE("files that may not grow are a full disk, whatever is being written", "[store fault]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.reindex(0);
    const StoreOnDisk store(corpus.store());
    const auto current = store.current();
    const std::string digests = store.digests();
    corpus.add_take("good/good_2.amc");

    int refused = 0;
    for (const rlim_t limit : {0u, 100u, 2000u, 5000u, 20000u, 50000u, 100000u}) {
        INFO("limit " << limit);
        Command command = program(reindex(corpus.path(), store.path(), {"--clusters", "5"}));
        command.file_limit = limit;
        const CommandResult full = run(command);
        INFO(full.errors);
        CHECK(full.exit_code == cannot_create);
        refused += full.exit_code == cannot_create;
        require_untouched(store, current, digests);
    }
    CHECK(refused == 7);
    CHECK(contains(corpus.reindex(0).output, "2 indexed (1 new"));
    CHECK(store.generations().size() == 2);
}

TEST_CASE("where one may not write, nothing is written", "[store fault]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const fs::path closed = corpus.folder() / "closed";
    fs::create_directory(closed);
    fs::permissions(closed, fs::perms::owner_read | fs::perms::owner_exec);
    Command command = program(reindex(corpus.path(), closed / "store", {"--clusters", "5"}));
    command.as_ordinary_user = true;
    const CommandResult refused = run(command);
    CHECK(refused.exit_code == cannot_create);
    CHECK(contains(refused.errors, "Permission denied"));
    CHECK(fs::is_empty(closed));

    // Readers need no right to write.
    corpus.reindex(0);
    const StoreOnDisk store(corpus.store());
    for (const auto& entry : fs::recursive_directory_iterator(store.path())) {
        if (entry.is_directory()) {
            fs::permissions(entry.path(), fs::perms::owner_read | fs::perms::owner_exec);
        }
    }
    Command verify = program({"verify", store.name(), "--digest"});
    verify.as_ordinary_user = true;
    const CommandResult verified = run(verify);
    INFO(verified.errors);
    CHECK(verified.exit_code == 0);
    CHECK(verified.output == store.digests());
}

TEST_CASE("a folder of another kind is not scribbled in", "[store fault]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const fs::path home = corpus.folder() / "home";
    write_text(home / "diary.txt", "private");
    CHECK(contains(require_program(reindex(corpus.path(), home), cannot_create).errors,
                   "is not a Kinetome store, and not empty"));
    CHECK(std::distance(fs::directory_iterator(home), fs::directory_iterator()) == 1);
    const fs::path file = corpus.folder().write("file", "not a folder");
    require_program(reindex(corpus.path(), file), cannot_create);
    CHECK(text_of(file) == "not a folder");
    for (const std::string reader : {"info", "verify", "gc", "publish"}) {
        CHECK(contains(require_program({reader, home.string()}, damaged).errors,
                       "is not a Kinetome store"));
        CHECK(contains(
            require_program({reader, (corpus.folder() / "nowhere").string()}, damaged).errors,
            "there is no store"));
    }
}

TEST_CASE("any flipped bit of the mark of a store is noticed", "[store fault]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.reindex(0);
    const StoreOnDisk store(corpus.store());
    const fs::path mark = store.path() / "kinetome_store.json";
    for (size_t bit = 0; bit < 8 * fs::file_size(mark); ++bit) {
        INFO("bit " << bit);
        flip_bit(mark, bit);
        CHECK(run_program({"verify", store.name()}).exit_code == damaged);
        flip_bit(mark, bit);
    }
    CHECK(run_program({"verify", store.name()}).exit_code == 0);
}

TEST_CASE("a store of a newer format is neither read nor written", "[store fault]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.reindex(0);
    const StoreOnDisk store(corpus.store());
    const std::string digests = store.digests();
    const fs::path mark = store.path() / "kinetome_store.json";
    const std::string of_today = text_of(mark);
    write_text(mark, "{\"kinetome_format\":2}\n");
    corpus.add_take("good/good_2.amc");
    for (const auto& command : std::vector<std::vector<std::string>>{
             reindex(corpus.path(), store.path()),
             {"info", store.name()},
             {"verify", store.name()},
             {"export", store.name(), "clips"},
             {"gc", store.name()},
             {"diff", store.name(), "current", "current"},
             {"publish", store.name()},
             {"ingest", corpus.path().string(), "--store", store.name()}}) {
        INFO(command.at(0));
        CHECK(contains(require_program(command, damaged).errors, "newer Kinetome"));
    }
    write_text(mark, of_today);
    require_untouched(store, store.current(), digests);
}

TEST_CASE("any flipped bit of a generation is found by verify, naming the file", "[store fault]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.reindex(0);
    const StoreOnDisk store(corpus.store());
    std::mt19937_64 random(8);
    constexpr int bits_per_file = 12;
    std::set<std::string> files;
    for (const auto& entry : fs::directory_iterator(store.path() / "current/")) {
        const fs::path file = entry.path();
        const std::string name = file.filename().string();
        files.insert(name);
        for (int i = 0; i < bits_per_file; ++i) {
            const size_t bit = random() % (8 * fs::file_size(file));
            INFO(name << ", bit " << bit);
            flip_bit(file, bit);
            const CommandResult verified = run_program({"verify", store.name()});
            CHECK(verified.exit_code == damaged);
            CHECK(contains(verified.errors, name));
            CHECK(run_program({"verify", store.name(), "--digest"}).output.empty());
            if (name == "catalog.json" || name == "ledger.json") {
                CHECK(run_program({"info", store.name()}).exit_code == damaged);
                CHECK(run_program({"export", store.name(), "clips"}).exit_code == damaged);
            }
            if (name == "motion_strings.h5") {
                const CommandResult read = run_program({"export", store.name(), "letters"});
                CHECK(read.exit_code == damaged);
                CHECK(contains(read.errors, name));
                CHECK(read.output.empty());
            }
            flip_bit(file, bit);
        }
    }
    CHECK(files.size() == 15);
    CHECK(run_program({"verify", store.name()}).exit_code == 0);
}

TEST_CASE("a file that is gone, short, long or strange is found by verify", "[store fault]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.reindex(0);
    const StoreOnDisk store(corpus.store());
    const auto verify_tells = [&](const std::string& what) {
        const CommandResult verified = run_program({"verify", store.name()});
        INFO(verified.errors);
        CHECK(verified.exit_code == damaged);
        CHECK(contains(verified.errors, what));
    };
    for (const std::string name :
         {"catalog.json", "ledger.json", "config.toml", "frames-last.h5", "pose_clusters.h5"}) {
        INFO(name);
        const fs::path file = store.file(name);
        const std::string bytes = text_of(file);
        fs::remove(file);
        verify_tells(name);
        write_text(file, bytes.substr(0, bytes.size() / 2));
        verify_tells(name);
        write_text(file, "");
        verify_tells(name);
        write_text(file, bytes + "x");
        verify_tells(name);
        write_text(file, bytes);
    }
    write_text(store.file("stranger.h5"), "x");
    verify_tells("stranger.h5: not in the ledger");
    fs::remove(store.file("stranger.h5"));
    CHECK(run_program({"verify", store.name()}).exit_code == 0);
}

TEST_CASE("a run does not build on a generation whose ledger is damaged", "[store fault]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.reindex(0);
    const StoreOnDisk store(corpus.store());
    const std::string digests = store.digests();
    for (const std::string name : {"ledger.json", "catalog.json"}) {
        INFO(name);
        flip_bit(store.file(name), 999);
        const CommandResult again = corpus.reindex(0);
        CHECK(contains(again.errors, "cannot be built on"));
        CHECK(store.digests() == digests);
    }
}

TEST_CASE("the second writer is turned away, and told who is writing", "[store fault]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const StoreOnDisk store(corpus.store());
    Process first(program(reindex(corpus.path(), store.path(), {"--clusters", "5"})));
    wait_until([&] { return fs::is_symlink(writer_lock(store)) || first.ended(); });
    first.signal(SIGSTOP);
    REQUIRE(fs::is_symlink(writer_lock(store)));

    for (const auto& command : std::vector<std::vector<std::string>>{
             reindex(corpus.path(), store.path()),
             {"publish", store.name()},
             {"gc", store.name()},
             {"ingest", corpus.path().string(), "--store", store.name(), "--slice", "1/2"}}) {
        INFO(command.at(0));
        const CommandResult second = require_program(command, cannot_create);
        CHECK(contains(second.errors, "process " + std::to_string(first.id()) + " on "));
    }
    first.signal(SIGCONT);
    CHECK(first.wait().exit_code == 0);
    CHECK(run_program({"verify", store.name()}).exit_code == 0);
}
