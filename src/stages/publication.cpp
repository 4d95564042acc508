#include "kinetome/stages/publication.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"

namespace kinetome {
namespace {

/// Stages all of whose work is finished and whose inputs are complete stages.
std::set<std::string> complete_stages(const RunPlan& plan, const FinishedPlan& finished) {
    std::set<std::string> complete;
    for (const StageRow& stage : stage_table()) {
        bool all = true;
        for (size_t i = 0; i < plan.work.size(); ++i) {
            if (plan.work[i].stage == &stage && !finished[i]) all = false;
        }
        for (const std::string& input : stage.inputs) all = all && complete.count(input);
        if (all) complete.insert(stage.name);
    }
    return complete;
}

/// Finished work of some stages; nothing in the places of others.
FinishedPlan work_of(const std::set<std::string>& stages, const RunPlan& plan,
                     FinishedPlan finished) {
    for (size_t i = 0; i < finished.size(); ++i) {
        if (!stages.count(plan.work[i].stage->name)) finished[i].reset();
    }
    return finished;
}

void enter(const ClipOutcome& outcome, const std::string& stage, CatalogClip& clip) {
    if (!outcome.quarantined.empty()) clip.quarantined = outcome.quarantined;
    if (!outcome.skipped.empty()) clip.skipped[stage] = outcome.skipped;
    if (!outcome.clip_class.empty()) {
        clip.frames = outcome.frames;
        clip.rate = outcome.rate;
        clip.clip_class = outcome.clip_class;
        clip.capabilities = outcome.capabilities;
    }
    clip.warnings.insert(clip.warnings.end(), outcome.warnings.begin(), outcome.warnings.end());
}

void list_removed(const Catalog& last, Catalog& catalog) {
    std::set<std::string> names;
    for (const CatalogClip& clip : catalog.clips) names.insert(clip.name);
    for (const CatalogClip& clip : last.clips) {
        if (!names.count(clip.name)) catalog.removed.push_back(clip.name);
    }
}

/// Sorts the indexed clips into reused, added and changed.
void count_clips(const Generation* last, Publication& publication) {
    std::map<std::string, const CatalogClip*> before;
    if (last) {
        for (const CatalogClip& clip : last->catalog().clips) {
            if (clip.indexed()) before[clip.name] = &clip;
        }
    }
    for (const CatalogClip& clip : publication.catalog.clips) {
        if (!clip.indexed()) continue;
        const auto earlier = before.find(clip.name);
        if (earlier == before.end()) {
            ++publication.added;
        } else if (earlier->second->content == clip.content) {
            ++publication.reused;
        } else {
            ++publication.changed;
        }
    }
}

void require_law(bool holds, const std::string& law) {
    if (!holds) {
        throw Error(ExitCode::internal, "not published, because a law does not hold: " + law);
    }
}

/// Every take that was found is accounted for, and nothing kept is older than what it was made of.
void check_laws(const RunPlan& plan, const Publication& publication) {
    const Catalog& catalog = publication.catalog;
    const auto found = static_cast<int64_t>(plan.survey.takes.size());
    require_law(found == catalog.indexed() + catalog.quarantined(),
                fmt::format("clips found ({}) = indexed ({}) + quarantined ({})", found,
                            catalog.indexed(), catalog.quarantined()));
    require_law(
        catalog.indexed() == publication.reused + publication.added + publication.changed,
        fmt::format("indexed ({}) = reused ({}) + new ({}) + changed ({})", catalog.indexed(),
                    publication.reused, publication.added, publication.changed));
    for (const CatalogClip& clip : catalog.clips) {
        require_law(!clip.indexed() || clip.frames > 0,
                    path_for_message(clip.name) + ": an indexed clip has frames");
    }
    std::map<std::string, Digest> keys;
    for (const PlannedWork& work : plan.work) keys[work.file_name] = work.key.digest();
    for (const Receipt& receipt : publication.ledger.receipts) {
        require_law(keys[receipt.file.file_name] == receipt.key.digest(),
                    receipt.file.file_name + ": no kept artifact is stale");
    }
}

std::string file_text(const std::filesystem::path& path) {
    return std::filesystem::exists(path) ? read_file(path) : std::string();
}

/// What the run's parts wrote, each in a file of its own: lines of several machines in one would
/// overwrite each other on a network's file system.
std::string joined_logs(const std::filesystem::path& run_folder) {
    std::set<std::filesystem::path> parts;
    for (const auto& entry : std::filesystem::directory_iterator(run_folder)) {
        if (entry.path().filename().string().starts_with("log-of-")) parts.insert(entry.path());
    }
    std::string text;
    for (const auto& part : parts) text += read_file(part);
    return text + file_text(run_folder / "log.txt");
}

/// Whether the last generation already is what would be published.
bool is_up_to_date(const Generation* last, const Publication& publication,
                   const FinishedPlan& finished, const std::string& configuration) {
    if (!last) return false;
    for (const auto& work : finished) {
        if (work && !work->from_generation) return false;
    }
    Catalog same = publication.catalog;
    same.removed = last->catalog().removed;  // tells of the step before, not of what is there
    same.corpus = last->catalog().corpus;    // the same folder may be written another way
    return publication.catalog.removed.empty() &&
           write_catalog(same) == write_catalog(last->catalog()) &&
           publication.ledger.receipts.size() == last->ledger().receipts.size() &&
           configuration == file_text(last->folder() / "config.toml");
}

}  // namespace

Catalog make_catalog(const RunPlan& plan, const FinishedPlan& finished, const Generation* last) {
    Catalog catalog;
    catalog.corpus = plan.survey.corpus.string();
    std::map<std::string, CatalogClip> clips;
    for (const Shard& shard : plan.shards) {
        for (const size_t i : shard.clips) {
            const Take& take = plan.survey.takes[i];
            CatalogClip& clip = clips[take.name];
            clip.name = take.name;
            clip.id = clip_id(take.name);
            clip.source = take.source;
            clip.content = take.content;
            clip.skeleton_source = take.skeleton_source;
            clip.claimed_frames = take.claimed_frames;
            clip.shard = shard.cut;
            clip.quarantined = take.quarantined;
        }
    }
    for (const auto& work : finished) {
        if (!work) continue;
        for (const ClipOutcome& outcome : work->receipt.clips) {
            enter(outcome, work->receipt.stage, clips.at(outcome.clip));
        }
    }
    for (auto& [name, clip] : clips) catalog.clips.push_back(std::move(clip));
    if (last) list_removed(last->catalog(), catalog);
    return catalog;
}

Publication prepare_publication(const RunPlan& plan, const FinishedPlan& all_finished,
                                const Generation* last, const Log& log) {
    const std::set<std::string> complete = complete_stages(plan, all_finished);
    if (!complete.count("frames")) {
        throw Error(
            ExitCode::nothing_usable,
            "not published: frames are incomplete; run the missing ingest slices, or reindex");
    }
    for (const StageRow& stage : stage_table()) {
        if (!stage.is_wanted(plan.options)) continue;
        if (complete.count(stage.name)) continue;
        if (last && !last->ledger().of_stage(stage.name).empty()) {
            log.warning("{}: not complete, left out; generation {} has it", stage.name, last->id());
        } else {
            log.info("{}: not complete, left out", stage.name);
        }
    }
    const FinishedPlan finished = work_of(complete, plan, all_finished);
    Publication publication;
    publication.ledger.version = KINETOME_VERSION;
    for (const auto& work : finished) {
        if (work) publication.ledger.receipts.push_back(work->receipt);
    }
    publication.catalog = make_catalog(plan, finished, last);
    if (publication.catalog.indexed() == 0) {
        throw Error(ExitCode::nothing_usable,
                    fmt::format("none of {} takes could be indexed; the first reason: {}",
                                publication.catalog.clips.size(),
                                publication.catalog.clips.front().quarantined));
    }
    count_clips(last, publication);
    check_laws(plan, publication);
    return publication;
}

Publication publish_plan(const RunPlan& plan, const FinishedPlan& all_finished,
                         Workspace& workspace, bool copy, const Log& log) {
    Publication publication = prepare_publication(plan, all_finished, workspace.last(), log);
    const FinishedPlan finished = work_of(complete_stages(plan, all_finished), plan, all_finished);
    const std::string configuration = write_configuration(plan.options);
    if (is_up_to_date(workspace.last(), publication, finished, configuration)) {
        publication.up_to_date = true;
        publication.generation = workspace.last()->id();
        log.info("generation {} is up to date: nothing to publish", publication.generation);
        return publication;
    }
    std::map<std::string, std::string> texts = {
        {"catalog.json", write_catalog(publication.catalog)},
        {"config.toml", configuration},
        {"log.txt", joined_logs(workspace.folder())}};
    for (const auto& [name, text] : texts) publication.ledger.texts[name] = digest_of(text);
    texts["ledger.json"] = write_ledger(publication.ledger);
    std::vector<StoreDirectory::File> files;
    for (const auto& work : finished) {
        if (work) files.push_back({work->receipt.file.file_name, work->path});
    }
    StoreDirectory store = workspace.store();
    publication.generation = store.publish(files, texts, copy);
    log.info(
        "published generation {}: {} clips indexed ({} new, {} changed, {} reused), "
        "{} quarantined, {} removed",
        publication.generation, publication.catalog.indexed(), publication.added,
        publication.changed, publication.reused, publication.catalog.quarantined(),
        publication.catalog.removed.size());
    return publication;
}

}  // namespace kinetome
