// Options that several commands share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "kinetome/base/log.h"
#include "kinetome/stages/options.h"
#include "kinetome/stages/reindex.h"

namespace kinetome::cli {

/// Options of every command.
struct CommonOptions {
    std::optional<int> threads;
    std::optional<uint64_t> memory;  ///< bytes
    LogOptions log;
};

void add_common_options(CLI::App& app, CommonOptions& options);

/// Every row of option_rows as a flag, --preset and --config. After parsing: preset first, then the
/// file, then the flags.
class ReindexFlags {
  public:
    /// What an option is that was not given: the default, or what the store was made with.
    enum class Otherwise { the_default, as_stored };
    /// `stages`: whose options alone are flags, for commands that are about them; none: of all.
    explicit ReindexFlags(CLI::App& app, std::set<std::string> stages = {},
                          Otherwise otherwise = Otherwise::the_default);
    /// All options. Throws UsageError when they make no sense together.
    ReindexOptions resolve() const;
    /// Name and value of those that were given and have a flag.
    std::map<std::string, std::string> given() const;

  private:
    struct Merged {
        ReindexOptions options;
        std::set<std::string> names;  ///< of the options that were given
    };
    Merged merge() const;

    struct Given {
        std::string name;
        std::string text;
        CLI::Option* flag;
    };
    bool has_flag(const OptionRow& row) const;

    std::set<std::string> stages_;
    std::string preset_;
    std::filesystem::path config_;
    std::vector<std::shared_ptr<Given>> given_;
};

/// The options of a run: all of them, or those that the run to be joined must agree with.
void take_options(const ReindexFlags& flags, ReindexRequest& request);

/// --node-scratch; what it points to is set by parsing.
std::shared_ptr<std::filesystem::path> add_node_scratch(CLI::App& app);
/// When the command runs, since nodes differ: throws UsageError when the folder is not on this one.
std::filesystem::path require_node_scratch(const std::filesystem::path& folder);

}  // namespace kinetome::cli
