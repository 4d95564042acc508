#include "options.h"

#include <algorithm>

#include "kinetome/base/error.h"
#include "kinetome/base/resources.h"

namespace kinetome::cli {

void add_common_options(CLI::App& app, CommonOptions& options) {
    const std::string group = "Common";
    app.add_option("--threads", options.threads,
                   "threads to use (default: what the job was granted)")
        ->group(group);
    app.add_option_function<std::string>(
           "--memory", [&options](const std::string& text) { options.memory = parse_bytes(text); },
           "memory to use, such as 8G (default: what the job was granted)")
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

ReindexFlags::ReindexFlags(CLI::App& app) {
    app.add_option("--preset", preset_, "paper: every option at the paper's value")
        ->check(CLI::IsMember({"paper"}));
    app.add_option("--config", config_, "file of options, as config.toml of a generation");
    ReindexOptions defaults;
    for (const OptionRow& row : option_rows(defaults)) {
        auto given = std::make_shared<Given>(Given{row.name, "", nullptr});
        given->flag = app.add_option("--" + row.name, given->text, row.help)
                          ->default_str(row.get())
                          ->group(row.stage.empty() || row.stage == "files" ? "Files" : row.stage);
        given_.push_back(given);
    }
}

ReindexOptions ReindexFlags::resolve() const {
    ReindexOptions options = preset_ == "paper" ? paper_options() : ReindexOptions();
    if (!config_.empty()) read_configuration(config_, options);
    for (OptionRow& row : option_rows(options)) {
        for (const auto& given : given_) {
            if (given->name == row.name && given->flag->count()) row.set(given->text);
        }
    }
    std::string& joint_map = options.frames.joint_map;  // `publish` may run in another folder
    if (!joint_map.empty()) joint_map = std::filesystem::absolute(joint_map).lexically_normal();
    check_options(options);
    return options;
}

}  // namespace kinetome::cli
