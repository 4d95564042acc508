#include "kinetome/stages/generation_record.h"

#include <set>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"

namespace kinetome {
namespace {

/// Takes that were read, if in vain.
std::set<std::string> takes_read(const Generation& generation) {
    std::set<std::string> read;
    for (const Receipt* receipt : generation.ledger().of_stage("frames")) {
        for (const ClipOutcome& outcome : receipt->clips) read.insert(outcome.clip);
    }
    return read;
}

/// As the survey found them: what reading a take told is not known before.
Survey survey_of(const Generation& generation) {
    const std::set<std::string> read = takes_read(generation);
    Survey survey;
    survey.corpus = generation.catalog().corpus;
    for (const CatalogClip& clip : generation.catalog().clips) {
        survey.takes.push_back({.name = clip.name,
                                .source = clip.source,
                                .skeleton_source = clip.skeleton_source,
                                .content = clip.content,
                                .claimed_frames = clip.claimed_frames,
                                .bytes = 0,
                                .quarantined = read.count(clip.name) ? "" : clip.quarantined});
    }
    return survey;
}

ReindexOptions options_of(const Generation& generation) {
    const std::filesystem::path file = generation.folder() / "config.toml";
    const std::string text = read_file(file);
    const auto& texts = generation.ledger().texts;
    const auto written = texts.find("config.toml");
    if (written == texts.end() || written->second != digest_of(text)) {
        throw DamagedError(path_for_message(file.string()) +
                           ": damaged: its bytes do not match the ledger");
    }
    ReindexOptions options;
    parse_configuration(text, file.string(), options);
    return options;
}

}  // namespace

RunRecord record_of(const Generation& generation) {
    return {survey_of(generation), options_of(generation)};
}

}  // namespace kinetome
