#include "kinetome/stages/comparison.h"

#include <fmt/format.h>

#include <map>

#include "kinetome/base/file.h"
#include "kinetome/stages/options.h"
#include "kinetome/stages/verification.h"

namespace kinetome {
namespace {

std::map<std::string, Digest> indexed_contents(const Generation& generation) {
    std::map<std::string, Digest> contents;
    for (const CatalogClip& clip : generation.catalog().clips) {
        if (clip.indexed()) contents[clip.name] = clip.content;
    }
    return contents;
}

void compare_clips(const Generation& first, const Generation& second,
                   GenerationDifference& difference) {
    const auto before = indexed_contents(first), after = indexed_contents(second);
    for (const auto& [name, content] : after) {
        const auto earlier = before.find(name);
        if (earlier == before.end()) {
            difference.added.push_back(name);
        } else if (earlier->second != content) {
            difference.changed.push_back(name);
        }
    }
    for (const auto& [name, content] : before) {
        if (!after.count(name)) difference.removed.push_back(name);
    }
}

ReindexOptions options_of(const Generation& generation) {
    ReindexOptions options;
    const auto path = generation.folder() / "config.toml";
    parse_configuration(read_file(path), path.string(), options);
    return options;
}

void compare_options(const Generation& first, const Generation& second,
                     GenerationDifference& difference) {
    ReindexOptions before = options_of(first), after = options_of(second);
    const auto rows_before = option_rows(before), rows_after = option_rows(after);
    for (size_t i = 0; i < rows_before.size(); ++i) {
        const std::string was = rows_before[i].get(), is = rows_after[i].get();
        if (was != is) {
            difference.options.push_back(
                fmt::format("{}: '{}' → '{}'", rows_before[i].name, was, is));
        }
    }
}

void compare_files(const Generation& first, const Generation& second,
                   GenerationDifference& difference) {
    for (const Receipt& receipt : second.ledger().receipts) {
        const Receipt* earlier = first.ledger().find(receipt.file.file_name);
        if (!earlier) {
            difference.files.push_back(receipt.file.file_name + ": is new");
        } else if (earlier->key.digest() != receipt.key.digest()) {
            difference.files.push_back(receipt.file.file_name + ": " +
                                       receipt.key.difference_from(earlier->key));
        } else if (earlier->file.hash != receipt.file.hash) {
            difference.files.push_back(receipt.file.file_name + ": made again, other bytes");
        }
    }
    for (const Receipt& receipt : first.ledger().receipts) {
        if (!second.ledger().find(receipt.file.file_name)) {
            difference.files.push_back(receipt.file.file_name + ": is gone");
        }
    }
}

void compare_datasets(const Generation& first, const Generation& second,
                      GenerationDifference& difference) {
    const auto by_name = [](const Generation& generation) {
        std::map<std::string, Digest> digests;
        for (const LogicalDigest& digest : logical_digests(generation)) {
            digests[digest.artifact + " " + digest.dataset] = digest.digest;
        }
        return digests;
    };
    const auto before = by_name(first), after = by_name(second);
    for (const auto& [name, digest] : after) {
        const auto earlier = before.find(name);
        if (earlier == before.end()) {
            difference.datasets.push_back(name + ": is new");
        } else if (earlier->second != digest) {
            difference.datasets.push_back(name + ": differs");
        }
    }
    for (const auto& [name, digest] : before) {
        if (!after.count(name)) difference.datasets.push_back(name + ": is gone");
    }
}

}  // namespace

bool GenerationDifference::empty() const {
    return added.empty() && removed.empty() && changed.empty() && options.empty() &&
           files.empty() && datasets.empty();
}

GenerationDifference compare_generations(const Generation& first, const Generation& second) {
    GenerationDifference difference;
    compare_clips(first, second, difference);
    compare_options(first, second, difference);
    compare_files(first, second, difference);
    compare_datasets(first, second, difference);
    return difference;
}

}  // namespace kinetome
