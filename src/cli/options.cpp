#include "options.h"

#include <fmt/format.h>

#include <algorithm>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/base/resources.h"
#include "kinetome/run/node_share.h"

namespace kinetome::cli {

void add_common_options(CLI::App& app, CommonOptions& options) {
    const std::string group = "Common";
    app.add_option("--threads", options.threads,
                   "threads to use, in each rank (default: what the job was granted)")
        ->group(group);
    app.add_option_function<std::string>(
           "--memory", [&options](const std::string& text) { options.memory = parse_bytes(text); },
           "memory to use, in each rank, such as 8G (default: what the job was granted)")
        ->group(group);
    app.add_option_function<std::string>(
           "--log-format",
           [&options](const std::string& text) {
               options.log.format = text == "json" ? LogFormat::json : LogFormat::text;
           },
           "lines on standard error: text or json")
        ->check(CLI::IsMember({"text", "json"}))
        ->group(group);
    app.add_option("--log-file", options.log.file, "append the lines to a file as well")
        ->group(group);
    app.add_flag("--quiet", options.log.quiet, "only warnings and errors")->group(group);
}

ReindexFlags::ReindexFlags(CLI::App& app, std::set<std::string> stages, Otherwise otherwise)
    : stages_(std::move(stages)) {
    app.add_option("--preset", preset_, "paper: every option at the paper's value")
        ->check(CLI::IsMember({"paper"}));
    app.add_option("--config", config_, "file of options, as config.toml of a generation");
    ReindexOptions defaults;
    for (const OptionRow& row : option_rows(defaults)) {
        if (!has_flag(row)) continue;
        auto given = std::make_shared<Given>(Given{row.name, "", nullptr});
        given->flag =
            app.add_option("--" + row.name, given->text, row.help)
                ->default_str(otherwise == Otherwise::as_stored ? "as in the store" : row.get())
                ->group(row.stage.empty() || row.stage == "files" ? "Files" : row.stage);
        given_.push_back(given);
    }
}

bool ReindexFlags::has_flag(const OptionRow& row) const {
    return stages_.empty() || stages_.count(row.stage) > 0;
}

ReindexFlags::Merged ReindexFlags::merge() const {
    Merged merged;
    ReindexOptions& options = merged.options;
    if (preset_ == "paper") {
        options = paper_options();
        for (const OptionRow& row : option_rows(options)) merged.names.insert(row.name);
    }
    if (!config_.empty()) merged.names.merge(read_configuration(config_, options));
    for (OptionRow& row : option_rows(options)) {
        for (const auto& given : given_) {
            if (given->name != row.name || !given->flag->count()) continue;
            row.set(given->text);
            merged.names.insert(row.name);
        }
    }
    std::string& joint_map = options.frames.joint_map;  // `publish` may run in another folder
    if (!joint_map.empty()) joint_map = std::filesystem::absolute(joint_map).lexically_normal();
    return merged;
}

ReindexOptions ReindexFlags::resolve() const {
    ReindexOptions options = merge().options;
    check_options(options);
    return options;
}

std::map<std::string, std::string> ReindexFlags::given() const {
    Merged merged = merge();
    std::map<std::string, std::string> values;
    for (const OptionRow& row : option_rows(merged.options)) {
        if (has_flag(row) && merged.names.count(row.name)) values[row.name] = row.get();
    }
    return values;
}

void take_options(const ReindexFlags& flags, ReindexRequest& request) {
    if (request.join) {
        request.given_options = flags.given();
    } else {
        request.options = flags.resolve();
    }
}

std::filesystem::path require_node_scratch(const std::filesystem::path& folder) {
    std::error_code error;
    if (folder.empty() || std::filesystem::is_directory(folder, error)) return folder;
    throw UsageError(
        fmt::format("--node-scratch {}: no such folder on {}: it must be on every node",
                    path_for_message(folder.string()), place_of_this_process().node));
}

std::shared_ptr<std::filesystem::path> add_node_scratch(CLI::App& app) {
    auto folder = std::make_shared<std::filesystem::path>();
    app.add_option(
           "--node-scratch", *folder,
           "folder on this machine's own disk where files are put together, before they are "
           "copied into the store")
        ->group("Files");
    return folder;
}

}  // namespace kinetome::cli
