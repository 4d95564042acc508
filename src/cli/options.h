// Options that several commands share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "kinetome/base/log.h"
#include "kinetome/stages/options.h"

namespace kinetome::cli {

/// Options of every command.
struct CommonOptions {
    std::optional<int> threads;
    std::optional<uint64_t> memory;  ///< bytes
    LogOptions log;
};

void add_common_options(CLI::App& app, CommonOptions& options);

/// Every row of option_rows as a flag, --preset and --config. Call resolve() after parsing: preset
/// first, then the file, then the flags.
class ReindexFlags {
  public:
    explicit ReindexFlags(CLI::App& app);
    ReindexOptions resolve() const;

  private:
    struct Given {
        std::string name;
        std::string text;
        CLI::Option* flag;
    };
    std::string preset_;
    std::filesystem::path config_;
    std::vector<std::shared_ptr<Given>> given_;
};

}  // namespace kinetome::cli
