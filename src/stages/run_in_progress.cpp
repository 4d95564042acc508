#include "run_in_progress.h"

#include <fmt/format.h>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view record_name = "run.json";

RunRecord read_record(const fs::path& path) {
    return parse_run_record(read_file(path), path);
}

/// Nothing when there is none, or none that can be read.
std::optional<RunRecord> find_record(const fs::path& path) {
    if (!fs::exists(path)) return std::nullopt;
    try {
        return read_record(path);
    } catch (const StoreError&) {
        return std::nullopt;
    }
}

bool same_folder(const fs::path& a, const fs::path& b) {
    std::error_code error;
    return fs::equivalent(a, b, error) && !error;
}

void require_agreement(const ReindexRequest& request, RunRecord& record) {
    const fs::path& corpus = record.survey.corpus;
    if (!same_folder(request.corpus, corpus)) {
        throw UsageError(fmt::format(
            "{} is not the folder that the run was opened for, which is {}",
            path_for_message(request.corpus.string()), path_for_message(corpus.string())));
    }
    for (const OptionRow& row : option_rows(record.options)) {
        const auto given = request.given_options.find(row.name);
        if (given == request.given_options.end() || given->second == row.get()) continue;
        throw UsageError(fmt::format(
            "{} is {}, but the run was opened with {}: leave the option out, or open the run again",
            row.name, quote_for_message(given->second), quote_for_message(row.get())));
    }
}

}  // namespace

RunInProgress::RunInProgress(const StoreDirectory& store, const Log& terminal,
                             const std::string& slice)
    : store_(store), log_(terminal) {
    if (const auto id = store_.current()) open_last(*id);
    workspace_.emplace(store_, last(), verified_);
    log_.add_file(workspace_->folder() / (slice.empty() ? "log.txt" : "log-of-" + slice + ".txt"));
}

/// A damaged generation stays current until the run has made a whole one.
void RunInProgress::open_last(const std::string& id) {
    try {
        last_.emplace(store_, id, verified_);
    } catch (const DamagedError& error) {
        log_.warning("generation {} cannot be built on: {}; everything is made again", id,
                     error.what());
    }
}

std::optional<RunRecord> RunInProgress::opened() const {
    return find_record(record_file());
}

void RunInProgress::enter(const RunRecord& record, const std::string& slice) {
    const StoreLock moment = store_.lock_record();
    const auto before = opened();
    const bool changes = fs::exists(record_file()) && !(before && same_work(*before, record));
    if (changes) {
        if (const auto other = store_.other_slice_at_work(slice)) {
            throw CreateError(fmt::format(
                "{}: {} is at work for other takes or options: wait until it ends, or use its "
                "options",
                path_for_message(record_file().string()), *other));
        }
        log_.info(
            "the run in progress was for other takes or options: opened anew; what is finished "
            "and has the same key is used");
    }
    write_file_atomically(record_file(), write_run_record(record.survey, record.options));
}

bool same_work(const RunRecord& a, const RunRecord& b) {
    return a.survey.takes == b.survey.takes &&
           write_configuration(a.options) == write_configuration(b.options);
}

RunRecord joined_record(const ReindexRequest& request, const StoreDirectory& store) {
    const std::string open_again = fmt::format("`kinetome plan {} --store {} --open`",
                                               path_for_message(request.corpus.string()),
                                               path_for_message(store.path().string()));
    const fs::path path = store.run_folder() / record_name;
    if (!fs::exists(path)) {
        throw Error(ExitCode::nothing_usable,
                    fmt::format("{}: no run is open: {} opens one",
                                path_for_message(store.path().string()), open_again));
    }
    RunRecord record = read_record(path);
    require_agreement(request, record);
    record.survey.remedy_for_change = "open the run again with " + open_again;
    return record;
}

}  // namespace kinetome
