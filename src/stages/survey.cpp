#include "kinetome/stages/survey.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <set>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/pack_fields.h"
#include "kinetome/base/progress.h"
#include "kinetome/base/quote.h"
#include "kinetome/formats/take_format.h"
#include "kinetome/store/catalog.h"

namespace kinetome {
namespace fs = std::filesystem;
namespace {

std::string lower_case(std::string text) {
    for (char& c : text) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return text;
}

const TakeFormat* format_of(const std::string& path) {
    return find_take_format(fs::path(path).extension().string());
}

bool is_skeleton_file(const std::string& path) {
    const std::string extension = lower_case(fs::path(path).extension().string());
    return std::any_of(take_formats().begin(), take_formats().end(), [&](const TakeFormat& format) {
        return !extension.empty() && format.skeleton_extension == extension;
    });
}

/// Files below the corpus, paths relative to it, and folders that could not be read.
struct Listing {
    std::vector<std::string> takes;
    std::map<std::string, std::vector<std::string>> skeletons;  ///< folder → its skeleton files
    std::vector<std::pair<std::string, std::string>> unreadable;
};

/// Follows links to folders, each folder once.
class Walk {
  public:
    explicit Walk(fs::path corpus) : corpus_(std::move(corpus)) {}

    Listing run() {
        visit("");
        std::sort(listing_.takes.begin(), listing_.takes.end());
        for (auto& [folder, files] : listing_.skeletons) std::sort(files.begin(), files.end());
        return std::move(listing_);
    }

  private:
    void visit(const std::string& folder) {
        std::error_code error;
        const fs::path real = fs::canonical(corpus_ / folder, error);
        if (!error && !seen_.insert(real.string()).second) return;
        fs::directory_iterator entries(corpus_ / folder, error);
        if (error) {
            listing_.unreadable.emplace_back(folder, error.message());
            return;
        }
        std::vector<std::string> folders;
        for (const fs::directory_entry& entry : entries) {
            const std::string path = (fs::path(folder) / entry.path().filename()).string();
            std::error_code ignored;  // a dangling link is neither folder nor file
            if (entry.is_directory(ignored)) {
                folders.push_back(path);
            } else if (entry.is_regular_file(ignored)) {
                enter(folder, path);
            }
        }
        std::sort(folders.begin(), folders.end());
        for (const std::string& path : folders) visit(path);
    }

    void enter(const std::string& folder, const std::string& path) {
        if (format_of(path)) listing_.takes.push_back(path);
        if (is_skeleton_file(path)) listing_.skeletons[folder].push_back(path);
    }

    fs::path corpus_;
    Listing listing_;
    std::set<std::string> seen_;
};

/// The ASF of an AMC: NN.asf (NN: the stem up to its first '_'), <stem>.asf, or the only ASF of the
/// folder. Sets `reason` when there is none.
std::string find_skeleton(const std::string& take, const Listing& listing, std::string& reason) {
    const fs::path path = take;
    const std::string folder = path.parent_path().string(), stem = path.stem().string();
    const auto found = listing.skeletons.find(folder);
    const std::vector<std::string> none;
    const auto& files = found == listing.skeletons.end() ? none : found->second;

    for (const std::string& wanted : {stem.substr(0, stem.find('_')), stem}) {
        for (const std::string& file : files) {
            if (fs::path(file).stem() == wanted) return file;
        }
    }
    if (files.size() == 1) return files.front();
    reason = fmt::format(
        "{}: no skeleton: looked for {}.asf, {}.asf and a single .asf file in its folder ({} "
        "there)",
        path_for_message(take), stem.substr(0, stem.find('_')), stem, files.size());
    return "";
}

/// The last `count` folders of a path and its stem: "b/02_01".
std::string tail_of(const fs::path& path, size_t count) {
    std::vector<std::string> folders;
    for (const fs::path& part : path.parent_path()) folders.push_back(part.string());
    std::string name;
    for (size_t i = folders.size() - std::min(count, folders.size()); i < folders.size(); ++i) {
        name += folders[i] + "/";
    }
    return name + path.stem().string();
}

std::string known_extensions() {
    std::vector<std::string_view> extensions;
    for (const TakeFormat& format : take_formats()) extensions.push_back(format.extension);
    return fmt::format("{}", fmt::join(extensions, ", "));
}

/// Two names with one id would mix their clips up wherever ids are compared.
void quarantine_equal_ids(std::vector<Take>& takes) {
    std::map<int64_t, const Take*> first;
    for (Take& take : takes) {
        const auto [found, is_first] = first.emplace(clip_id(take.name), &take);
        if (is_first) continue;
        take.quarantined =
            fmt::format("{}: its name has the same id as {}: rename one of them",
                        path_for_message(take.source), path_for_message(found->second->source));
    }
}

/// Content and claims of one take; a file that cannot be read is quarantined.
void examine(const fs::path& corpus, const std::map<std::string, Digest>& skeletons, Take& take) {
    try {
        const std::string bytes = read_source_file(corpus / take.source);
        take.bytes = bytes.size();
        take.content = content_digest(
            bytes, take.skeleton_source.empty() ? Digest{} : skeletons.at(take.skeleton_source));
        take.claimed_frames = format_of(take.source)->count_frames(bytes);
    } catch (const InputError& error) {
        take.quarantined = error.what();
    }
}

/// Content of each skeleton file; takes of one that cannot be read are quarantined.
void hash_skeletons(const fs::path& corpus, std::map<std::string, Digest>& skeletons,
                    std::vector<Take>& takes) {
    for (auto& [path, digest] : skeletons) {
        try {
            digest = digest_of(read_source_file(corpus / path));
        } catch (const InputError& error) {
            for (Take& take : takes) {
                if (take.skeleton_source == path) take.quarantined = error.what();
            }
        }
    }
}

void quarantine_duplicates(std::vector<Take>& takes) {
    std::map<Digest, const Take*> first;
    for (Take& take : takes) {
        if (!take.quarantined.empty()) continue;
        const auto [found, is_first] = first.emplace(take.content, &take);
        if (is_first) continue;
        take.quarantined = fmt::format("{}: the same content as {}", path_for_message(take.source),
                                       path_for_message(found->second->source));
    }
}

/// What rank 0 finds, before any take is read.
struct Findings {
    std::vector<Take> takes;                  ///< sorted by name
    std::map<std::string, Digest> skeletons;  ///< content of each skeleton file
};

void pack(Packer& out, const Take& take) {
    pack_all(out, take.name, take.source, take.skeleton_source, take.quarantined,
             take.content.hex(), take.claimed_frames, take.bytes);
}

void unpack(Unpacker& in, Take& take) {
    std::string content;
    unpack_all(in, take.name, take.source, take.skeleton_source, take.quarantined, content,
               take.claimed_frames, take.bytes);
    take.content = Digest::from_hex(content);
}

void pack(Packer& out, const Findings& findings) {
    pack_each(out, findings.takes, [&](const Take& take) { pack(out, take); });
    out.put<uint64_t>(findings.skeletons.size());
    for (const auto& [path, content] : findings.skeletons) pack_all(out, path, content.hex());
}

void unpack(Unpacker& in, Findings& findings) {
    unpack_each(in, findings.takes, [&](Take& take) { unpack(in, take); });
    for (auto left = in.get<uint64_t>(); left > 0; --left) {
        std::string path, content;
        unpack_all(in, path, content);
        findings.skeletons[path] = Digest::from_hex(content);
    }
}

Findings find_takes(const fs::path& corpus) {
    if (!fs::is_directory(corpus)) {
        throw Error(ExitCode::nothing_usable, corpus.string() + ": no such folder");
    }
    const Listing listing = Walk(corpus).run();

    Findings found;
    const std::vector<std::string> names = name_takes(listing.takes);
    for (size_t i = 0; i < listing.takes.size(); ++i) {
        Take take;
        take.name = names[i];
        take.source = listing.takes[i];
        if (!format_of(take.source)->skeleton_extension.empty()) {
            take.skeleton_source = find_skeleton(take.source, listing, take.quarantined);
            if (!take.skeleton_source.empty()) found.skeletons[take.skeleton_source] = {};
        }
        found.takes.push_back(std::move(take));
    }
    for (const auto& [folder, reason] : listing.unreadable) {
        Take take;
        take.name = take.source = folder + "/";
        take.quarantined =
            fmt::format("{}: folder cannot be read: {}", path_for_message(folder), reason);
        found.takes.push_back(std::move(take));
    }
    if (found.takes.empty()) {
        throw Error(ExitCode::nothing_usable,
                    corpus.string() + ": no take found (looked for " + known_extensions() + ")");
    }
    std::sort(found.takes.begin(), found.takes.end(),
              [](const Take& a, const Take& b) { return a.name < b.name; });
    hash_skeletons(corpus, found.skeletons, found.takes);
    return found;
}

void examine_all(const fs::path& corpus, const std::map<std::string, Digest>& skeletons,
                 const std::vector<Take*>& takes, int threads, const Log& log,
                 const StopToken& stop) {
    Progress progress(log, "survey", static_cast<int64_t>(takes.size()), "takes");
    tbb::task_arena arena(threads);
    arena.execute([&] {
        tbb::parallel_for(size_t{0}, takes.size(), [&](size_t i) {
            stop.check();
            if (takes[i]->quarantined.empty()) examine(corpus, skeletons, *takes[i]);
            progress.advance();
        });
    });
}

}  // namespace

int64_t Survey::claimed_frames() const {
    int64_t total = 0;
    for (const Take& take : takes) total += take.claimed_frames;
    return total;
}

std::vector<ClipExtent> Survey::extents() const {
    std::vector<ClipExtent> extents;
    for (const Take& take : takes)
        extents.push_back({hash_name(take.name), take.claimed_frames, 0});
    return extents;
}

Digest content_digest(std::string_view take, const Digest& skeleton) {
    return Hasher().digest(digest_of(take)).digest(skeleton).finish();
}

std::vector<std::string> name_takes(const std::vector<std::string>& paths) {
    std::vector<std::string> names(paths.size());
    std::vector<size_t> open(paths.size());
    for (size_t i = 0; i < open.size(); ++i) open[i] = i;
    for (size_t folders = 0; !open.empty(); ++folders) {
        std::map<std::string, std::vector<size_t>> same;
        bool all_whole = true;
        for (const size_t i : open) {
            same[tail_of(paths[i], folders)].push_back(i);
            all_whole = all_whole && tail_of(paths[i], folders) == tail_of(paths[i], folders + 1);
        }
        open.clear();
        for (const auto& [name, members] : same) {
            for (const size_t i : members) {
                names[i] = name;
                if (members.size() > 1) open.push_back(i);
            }
        }
        if (all_whole) break;
    }
    for (const size_t i : open) names[i] = paths[i];  // they differ in their extension alone
    return names;
}

Survey survey_corpus(const fs::path& corpus, const Workers& workers, const Log& log,
                     const StopToken& stop) {
    Findings findings;
    if (workers.is_root()) findings = find_takes(corpus);
    if (workers.rank_count() > 1) {
        findings = unpacked<Findings>(workers.ranks->broadcast(packed(findings)));
    }
    std::vector<Take>& takes = findings.takes;
    std::vector<Take*> mine;
    for (size_t i = 0; i < takes.size(); ++i) {
        if (static_cast<int>(i % static_cast<size_t>(workers.rank_count())) == workers.rank()) {
            mine.push_back(&takes[i]);
        }
    }
    examine_all(corpus, findings.skeletons, mine, workers.threads, log, stop);
    if (workers.rank_count() > 1) {
        Packer examined;
        for (const Take* take : mine) pack(examined, *take);
        std::vector<Unpacker> parts;
        for (std::string& part : workers.ranks->gather_to_all(examined.take())) {
            parts.emplace_back(std::move(part));
        }
        for (size_t i = 0; i < takes.size(); ++i) unpack(parts[i % parts.size()], takes[i]);
    }
    Survey survey;
    survey.corpus = corpus;
    survey.takes = std::move(takes);
    quarantine_duplicates(survey.takes);
    quarantine_equal_ids(survey.takes);
    return survey;
}

}  // namespace kinetome
