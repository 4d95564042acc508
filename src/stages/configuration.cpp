#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <sstream>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/stages/options.h"

namespace kinetome {
namespace {

/// One value as the option's text, from whatever TOML type it has.
std::string toml_text(const std::string& origin, const std::string& name, const toml::node& node) {
    if (const auto value = node.value_exact<std::string>()) return *value;
    if (const auto value = node.value_exact<int64_t>()) return fmt::format("{}", *value);
    if (const auto value = node.value_exact<double>()) return fmt::format("{}", *value);
    if (const toml::array* array = node.as_array()) {
        std::vector<std::string> parts;
        for (const toml::node& part : *array) parts.push_back(toml_text(origin, name, part));
        return fmt::format("{}", fmt::join(parts, ","));
    }
    throw UsageError(fmt::format("{}:{}: {} must be a number or a text", origin,
                                 node.source().begin.line, name));
}

std::string quoted(const std::string& text) {
    std::ostringstream out;
    out << toml::value<std::string>(text);
    return out.str();
}

}  // namespace

std::set<std::string> parse_configuration(std::string_view text, const std::string& origin,
                                          ReindexOptions& options) {
    toml::table table;
    try {
        table = toml::parse(text, origin);
    } catch (const toml::parse_error& error) {
        throw UsageError(
            fmt::format("{}:{}: {}", origin, error.source().begin.line, error.description()));
    }
    auto rows = option_rows(options);
    std::set<std::string> names;
    for (const auto& [key, node] : table) {
        const std::string name(key.str());
        const auto row = std::find_if(rows.begin(), rows.end(),
                                      [&](const OptionRow& r) { return r.name == name; });
        if (row == rows.end()) {
            throw UsageError(fmt::format("{}:{}: no option is called '{}'", origin,
                                         node.source().begin.line, name));
        }
        try {
            row->set(toml_text(origin, name, node));
        } catch (const UsageError& error) {
            throw UsageError(
                fmt::format("{}:{}: {}", origin, node.source().begin.line, error.what()));
        }
        names.insert(name);
    }
    return names;
}

std::set<std::string> read_configuration(const std::filesystem::path& file,
                                         ReindexOptions& options) {
    if (!std::filesystem::is_regular_file(file)) {
        throw UsageError(file.string() + ": no such configuration file");
    }
    return parse_configuration(read_file(file), file.string(), options);
}

std::string write_configuration(const ReindexOptions& options) {
    ReindexOptions copy = options;
    std::string text =
        "# Options in force, defaults written out. `kinetome reindex --config` reads it.\n";
    for (const OptionRow& row : option_rows(copy)) {
        const std::string value = row.get();
        text += fmt::format("\n# {}\n{} = {}\n", row.help, row.name,
                            row.kind == OptionKind::text ? quoted(value) : value);
    }
    return text;
}

}  // namespace kinetome
