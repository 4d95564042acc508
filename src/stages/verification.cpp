#include "kinetome/stages/verification.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <set>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"
#include "kinetome/stages/stage.h"

namespace kinetome {
namespace fs = std::filesystem;
namespace {

class Findings {
  public:
    /// Runs a check; what it throws is a finding.
    template <class Check>
    void note(Check check) {
        try {
            check();
        } catch (const Error& error) {
            lines.push_back(error.what());
        }
    }
    void require(bool holds, std::string line) {
        if (!holds) lines.push_back(std::move(line));
    }
    std::vector<std::string> lines;
};

void check_file(const fs::path& path, const Receipt& receipt, Findings& findings) {
    if (!fs::exists(path)) {
        findings.lines.push_back(path.string() + ": missing");
        return;
    }
    if (digest_file(path) == receipt.file.hash) return;
    const auto datasets = unreadable_datasets(path);
    findings.lines.push_back(
        fmt::format("{}: damaged: its bytes do not match the ledger{}", path.string(),
                    datasets.empty() ? "" : fmt::format("; in {}", fmt::join(datasets, ", "))));
}

void check_laws(const Generation& generation, Findings& findings) {
    const Catalog& catalog = generation.catalog();
    std::set<std::string> names, shards;
    for (const CatalogClip& clip : catalog.clips) {
        findings.require(names.insert(clip.name).second,
                         path_for_message(clip.name) + ": in the catalog twice");
        findings.require(clip.id == clip_id(clip.name),
                         path_for_message(clip.name) + ": has another clip's id");
        shards.insert(clip.shard);
    }
    std::set<std::string> kept;
    for (const Receipt& receipt : generation.ledger().receipts) {
        findings.require(kept.insert(receipt.file.file_name).second,
                         receipt.file.file_name + ": in the ledger twice");
        findings.require(receipt.shard.empty() || shards.count(receipt.shard),
                         receipt.file.file_name + ": of a shard that no clip is in");
    }
    for (const std::string& shard : shards) {
        findings.require(kept.count("frames-" + shard + ".h5"),
                         "frames-" + shard + ".h5: not in the ledger, though clips are in it");
    }
}

/// Receipts of a stage grouped as one logical artifact: same datasets, shard after shard.
std::vector<LogicalDigest> digests_of_stage(const Generation& generation,
                                            const std::string& stage) {
    std::map<std::string, DatasetSpec> specs;
    std::map<std::string, DatasetDigest> digests;
    std::map<std::string, Digest> constants;
    for (const Receipt* receipt : generation.ledger().of_stage(stage)) {
        const ArtifactReader file = generation.open(receipt->file.file_name);
        for (const DatasetSpec& spec : file.datasets()) {
            const auto [known, is_new] = specs.emplace(spec.path, spec);
            if (!is_new && !(known->second == spec)) {
                throw StoreError(fmt::format("{}: {} is not the same kind of dataset in all shards",
                                             receipt->file.file_name, spec.path));
            }
            if (spec.sharding == Sharding::constant) {
                DatasetDigest digest(spec);
                file.digest_rows(spec.path, digest);
                const auto [first, is_first] = constants.emplace(spec.path, digest.finish());
                if (!is_first && first->second != digest.finish()) {
                    throw StoreError(fmt::format("{}: {} differs from the other shards",
                                                 receipt->file.file_name, spec.path));
                }
            } else {
                file.digest_rows(spec.path, digests.try_emplace(spec.path, spec).first->second);
            }
        }
    }
    std::vector<LogicalDigest> result;
    for (const auto& [path, spec] : specs) {
        const bool constant = spec.sharding == Sharding::constant;
        result.push_back({stage, path, constant ? constants.at(path) : digests.at(path).finish()});
    }
    return result;
}

}  // namespace

std::vector<std::string> verify_generation(const StoreDirectory& store, const std::string& id) {
    Findings findings;
    findings.note([&] {
        VerifiedFiles verified;
        const Generation generation(store, id, verified);
        std::set<std::string> known = {"ledger.json"};
        for (const auto& [name, hash] : generation.ledger().texts) {
            findings.note([&, &path = name, &expected = hash] {
                require_hash(generation.folder() / path, expected);
            });
            known.insert(name);
        }
        for (const Receipt& receipt : generation.ledger().receipts) {
            findings.note([&] {
                check_file(generation.folder() / receipt.file.file_name, receipt, findings);
            });
            known.insert(receipt.file.file_name);
        }
        for (const auto& entry : fs::directory_iterator(generation.folder())) {
            findings.require(known.count(entry.path().filename().string()),
                             entry.path().string() + ": not in the ledger");
        }
        check_laws(generation, findings);
        findings.note([&] {
            ReindexOptions options;
            const fs::path path = generation.folder() / "config.toml";
            parse_configuration(read_file(path), path.string(), options);
        });
    });
    return findings.lines;
}

std::vector<LogicalDigest> logical_digests(const Generation& generation) {
    std::vector<LogicalDigest> all;
    for (const StageRow& stage : stage_table()) {
        const auto digests = digests_of_stage(generation, stage.name);
        all.insert(all.end(), digests.begin(), digests.end());
    }
    return all;
}

}  // namespace kinetome
