// docs/artifacts.md and the files of a store, held together in both directions.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "kinetome/base/file.h"
#include "kinetome/stages/export.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/reindex.h"
#include "kinetome/stages/stored_graph.h"
#include "kinetome/store/json_text.h"
#include "kinetome/synthesis/corpus_generator.h"
#include "support/temporary_folder.h"

using namespace kinetome;
namespace fs = std::filesystem;

namespace {

using Cells = std::vector<std::string>;

/// What the document says below one heading that is the name of a file.
struct DocumentedFile {
    int group_depth = 0;       ///< of "Groups `/<class>/<partition>/`"
    std::vector<Cells> table;  ///< rows that begin with a name
};

std::string trimmed(const std::string& text) {
    const size_t first = text.find_first_not_of(' ');
    return first == std::string::npos ? ""
                                      : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::vector<std::string> split(std::string text, const std::string& separator) {
    std::vector<std::string> parts;
    for (size_t end = 0; (end = text.find(separator)) != std::string::npos;) {
        parts.push_back(trimmed(text.substr(0, end)));
        text.erase(0, end + separator.size());
    }
    parts.push_back(trimmed(text));
    return parts;
}

/// All words in `backticks`.
std::set<std::string> quoted_words(const std::string& text) {
    static const std::regex word("`([^`]+)`");
    std::set<std::string> words;
    for (std::sregex_iterator at(text.begin(), text.end(), word), end; at != end; ++at) {
        words.insert((*at)[1].str());
    }
    return words;
}

/// By the heading they stand below; a heading that is no `name` keeps its text.
std::map<std::string, DocumentedFile> read_document() {
    std::istringstream lines(read_file(fs::path(KINETOME_SOURCE_DIR) / "docs" / "artifacts.md"));
    std::map<std::string, DocumentedFile> files;
    DocumentedFile* file = &files[""];
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("## ") || line.starts_with("### ")) {
            const auto names = quoted_words(line);
            file = &files[names.empty() ? line : *names.begin()];
        } else if (line.starts_with("Groups `")) {
            const std::string group = split(line, "`").at(1);
            file->group_depth = static_cast<int>(std::ranges::count(group, '<'));
        } else if (line.starts_with("| `")) {
            file->table.push_back(split(line.substr(1, line.size() - 2), "|"));
        }
    }
    return files;
}

/// A row of a table of datasets.
struct DocumentedDataset {
    std::string type, units, sharding, description;
    std::vector<std::string> shape;  ///< numbers and names of sizes
};

std::map<std::string, DocumentedDataset> datasets_of(const DocumentedFile& file) {
    std::map<std::string, DocumentedDataset> datasets;
    for (const Cells& cells : file.table) {
        REQUIRE(cells.size() == 6);
        const auto& [path, type, shape, units, sharding, description] =
            std::tie(cells[0], cells[1], cells[2], cells[3], cells[4], cells[5]);
        datasets[*quoted_words(path).begin()] = {type, units, sharding, description,
                                                 split(shape, "×")};
    }
    return datasets;
}

/// "/class/partition/pca/mean" at depth 2 → {"/class/partition", "pca/mean"}.
std::pair<std::string, std::string> group_and_rest(const std::string& path, int depth) {
    size_t end = 0;
    for (int i = 0; i < depth; ++i) end = path.find('/', end + 1);
    return {path.substr(0, end), path.substr(end + 1)};
}

std::string kind_of(const Receipt& receipt) {
    return receipt.shard.empty() ? receipt.file.file_name : receipt.stage + "-<cut>.h5";
}

/// Two subjects, published twice: with one partition, then with one a subject.
class SmallStore {
  public:
    SmallStore() {
        generate_corpus({.frames = 3000, .subjects = 2}, folder_ / "takes", 2);
        publish(PartitionRule::none);
        publish(PartitionRule::subject);
    }

    std::vector<std::string> generations() const {
        return StoreDirectory::open(store()).generations();
    }
    fs::path store() const { return folder_ / "store"; }

  private:
    void publish(PartitionRule rule) {
        ReindexRequest request;
        request.corpus = folder_ / "takes";
        request.store = store();
        request.resources.threads = 2;
        request.resources.memory_bytes = uint64_t{1} << 30;
        request.options.partition.rule = rule;
        request.options.corpus_neighbors.wanted = true;
        request.options.pose_clusters.clusters = 70;  // more than a word of the bit matrix
        request.options.pose_clusters.mixture.max_iterations = 3;
        reindex(request, Log(), StopToken());
    }

    TemporaryFolder folder_;
};

/// Calls `visit(kind, file)` for each artifact of each generation.
template <class Visit>
void for_each_artifact(const SmallStore& small, Visit visit) {
    for (const std::string& id : small.generations()) {
        const OpenStore open(small.store(), id);
        for (const Receipt& receipt : open.generation.ledger().receipts) {
            visit(kind_of(receipt), open.generation.open(receipt.file.file_name));
        }
    }
}

/// Whether a size is the number, or what its name stands for in this group.
bool size_agrees(const std::string& documented, int64_t found,
                 std::map<std::string, int64_t>& sizes) {
    if (documented.find_first_not_of("0123456789") == std::string::npos) {
        return documented == fmt::format("{}", found);
    }
    return sizes.try_emplace(documented, found).first->second == found;
}

void check_dataset(const ArtifactReader& file, const DatasetSpec& found,
                   const DocumentedDataset& documented, std::map<std::string, int64_t>& sizes) {
    CHECK(documented.type == name_of(found.type));
    CHECK(documented.units == found.units);
    CHECK(documented.sharding == (found.sharding == Sharding::rows ? "rows" : "constant"));
    if (!found.source.empty()) {
        CHECK_THAT(documented.description, Catch::EndsWith("(" + found.source + ")"));
    }
    std::vector<int64_t> shape = {file.rows(found.path)};
    shape.insert(shape.end(), found.row_shape.begin(), found.row_shape.end());
    REQUIRE(documented.shape.size() == shape.size());
    for (size_t i = 0; i < shape.size(); ++i) {
        CAPTURE(documented.shape[i], shape[i]);
        CHECK(size_agrees(documented.shape[i], shape[i], sizes));
    }
}

std::set<std::string> first_column(const DocumentedFile& file) {
    std::set<std::string> names;
    for (const Cells& cells : file.table) names.merge(quoted_words(cells.front()));
    return names;
}

std::set<std::string> members_of(const Json& object) {
    std::set<std::string> names;
    for (const auto& [name, value] : object.items()) names.insert(name);
    return names;
}

}  // namespace

TEST_CASE("every dataset of a store is documented with its type, shape, units and sharding") {
    const auto document = read_document();
    for_each_artifact(SmallStore(), [&](const std::string& kind, const ArtifactReader& file) {
        CAPTURE(kind);
        REQUIRE(document.count(kind));
        const auto documented = datasets_of(document.at(kind));
        std::map<std::string, std::map<std::string, int64_t>> sizes_of_group;
        for (const DatasetSpec& spec : file.datasets()) {
            CAPTURE(spec.path);
            const auto [group, path] = group_and_rest(spec.path, document.at(kind).group_depth);
            REQUIRE(documented.count(path));
            check_dataset(file, spec, documented.at(path), sizes_of_group[group]);
        }
    });
}

TEST_CASE("every documented dataset is in every group of a store's files") {
    const auto document = read_document();
    std::set<std::string> kinds_found;
    for_each_artifact(SmallStore(), [&](const std::string& kind, const ArtifactReader& file) {
        kinds_found.insert(kind);
        const DocumentedFile& section = document.at(kind);
        std::set<std::string> groups;
        for (const DatasetSpec& spec : file.datasets()) {
            groups.insert(group_and_rest(spec.path, section.group_depth).first);
        }
        for (const std::string& group : groups) {
            for (const auto& [path, dataset] : datasets_of(section)) {
                CAPTURE(kind, group, path);
                CHECK(file.contains(group + "/" + path));
            }
        }
    });
    for (const auto& [name, section] : document) {
        if (name.ends_with(".h5")) CHECK(kinds_found.count(name));
    }
}

TEST_CASE("the members of catalog and ledger are the documented ones") {
    const auto document = read_document();
    const SmallStore small;
    const fs::path folder = small.store() / "current";
    const auto read = [&](const char* name) {
        return parse_json(read_file(folder / name), folder / name, "JSON");
    };
    CHECK(first_column(document.at("catalog.json")) ==
          members_of(read("catalog.json").at("clips").front()));
    CHECK(first_column(document.at("ledger.json")) ==
          members_of(read("ledger.json").at("ledger").at("receipts").front()));
}

TEST_CASE("exported tables have the documented columns") {
    const auto document = read_document();
    const SmallStore small;
    const OpenStore open(small.store());
    const auto& tables = document.at("## Exported tables");
    REQUIRE(tables.table.size() == 9);
    for (const Cells& cells : tables.table) {
        const std::string what = *quoted_words(cells[0]).begin();
        if (what == "primitive-graph") {
            const StoredGraph graph =
                stored_graph(stored_primitives(open), clip_source(open.generation), 2);
            const std::string text = write_graph(graph, GraphFormat::csv);
            CHECK(cells[1] == "`" + text.substr(0, text.find_first_of("\r\n")) + "`");
            continue;
        }
        if (what == "neighbors") {
            std::string text;
            write_neighbors(open.generation, TableFormat::csv,
                            [&](std::string_view piece) { text += piece; });
            CHECK(cells[1] == "`" + text.substr(0, text.find_first_of("\r\n")) + "`");
            continue;
        }
        const Table table = export_table(open, what);
        CHECK(cells[1] == fmt::format("`{}`", fmt::join(table.columns, ",")));
    }
}
