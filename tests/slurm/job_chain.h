// The jobs that jobs/submit.sh makes of a corpus.
#pragma once

#include <regex>
#include <string>
#include <vector>

#include "end_to_end/store_on_disk.h"
#include "slurm_cluster.h"

/// Ranks of the MPI job, where the program can have several: one a node.
#ifdef KINETOME_WITH_MPI
inline const std::string rank_count = "2";
#else
inline const std::string rank_count = "1";
#endif

/// Cancelled, at the latest, with this object.
class JobChain {
  public:
    JobChain(const fs::path& corpus, const fs::path& store, const std::vector<std::string>& more)
        : store_(store) {
        ::setenv("KINETOME", KINETOME_PROGRAM, 0);
        ::setenv("KINETOME_POLL_SECONDS", "0.2", 0);
        std::vector<std::string> words = {jobs + "submit.sh", corpus,    store,     "--nodes",
                                          rank_count,         "--ranks", rank_count};
        words.insert(words.end(), more.begin(), more.end());
        const CommandResult result = run({.words = words, .time_limit = 30});
        INFO(result.errors);
        REQUIRE(result.exit_code == 0);
        ingest = number_after(result.output, "ingest   job ");
        reindex = number_after(result.output, "reindex  job ");
        publish = number_after(result.output, "publish  job ");
    }
    ~JobChain() { run({.words = {"scancel", ingest, reindex, publish}, .time_limit = 30}); }
    JobChain(const JobChain&) = delete;
    JobChain& operator=(const JobChain&) = delete;

    std::string ingest, reindex, publish;  ///< their numbers

    static std::string state(const std::string& job) {
        return ask({"squeue", "-h", "-t", "all", "-j", job, "-o", "%T"});
    }
    static std::string nodes(const std::string& job) {
        return ask({"squeue", "-h", "-t", "all", "-j", job, "-o", "%N"});
    }
    std::string log(const std::string& name) const {
        return text_of(store_ / "scratch" / "jobs" / (name + ".log"));
    }

    /// As jobs/wait.sh does it.
    CommandResult wait() const {
        return run(
            {.words = {jobs + "wait.sh", store_, ingest, reindex, publish}, .time_limit = 240});
    }
    void require_published() const {
        const CommandResult ended = wait();
        INFO(ended.output);
        REQUIRE(ended.exit_code == 0);
    }

  private:
    static std::string number_after(const std::string& text, const std::string& mark) {
        std::smatch match;
        const std::regex number(mark + "(\\d+)");
        REQUIRE(std::regex_search(text, match, number));
        return match[1];
    }

    inline static const std::string jobs = KINETOME_SOURCE_DIR "/jobs/";
    fs::path store_;
};
