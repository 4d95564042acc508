// Corpora of a few short takes, for runs that end in a moment.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "support/temporary_folder.h"
#include "takes.h"

/// A performer's skeleton and one of their takes, as generated.
struct Performer {
    std::string asf, amc;
};

inline Performer make_performer(int seed = 1) {
    const TemporaryFolder folder;
    generate_corpus(folder / "takes", 1500, 1, seed);
    const fs::path home = folder / "takes" / "01";
    return {text_of(home / "01.asf"), first_frames(text_of(home / "01_01.amc"), 150)};
}

/// A corpus folder whose takes are short and differ in where they are performed.
class SmallCorpus {
  public:
    const fs::path& path() const { return path_; }
    fs::path store() const { return folder_ / "store"; }
    const TemporaryFolder& folder() const { return folder_; }
    const Performer& performer() const { return performer_; }

    /// Path below the corpus, without a skeleton; returns the whole path.
    fs::path add(const fs::path& name, const std::string& bytes) const {
        write_text(path_ / name, bytes);
        return path_ / name;
    }
    fs::path add_skeleton(const fs::path& name) const { return add(name, performer_.asf); }
    /// A good take, unlike all before.
    fs::path add_take(const fs::path& name) { return add(name, another_take()); }
    std::string another_take() { return shifted_take(performer_.amc, 10 * ++takes_); }

    /// The take good/good_1 and its skeleton.
    void add_good_take() {
        add_skeleton("good/good.asf");
        add_take("good/good_1.amc");
    }

    CommandResult reindex(int expected, std::vector<std::string> more = {}) const {
        more.insert(more.end(), {"--clusters", "5"});
        return require_program(::reindex(path_, store(), more), expected);
    }

  private:
    TemporaryFolder folder_;
    fs::path path_ = folder_ / "takes";
    Performer performer_ = make_performer();
    int takes_ = 0;
};
