#include "program.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <utility>

#include "kinetome/base/error.h"

namespace kinetome::bench {
namespace {

constexpr int internal_error = 70;

template <class Value>
constexpr bool is_list = false;
template <class Entry>
constexpr bool is_list<std::vector<Entry>> = true;

/// CLI11's own check tells the largest double, digit by digit.
CLI::Validator positive() {
    return {[](const std::string& text) {
                double number = 0;
                const bool is_positive = CLI::detail::lexical_cast(text, number) && number > 0;
                return is_positive ? std::string() : "expected a number above 0, found " + text;
            },
            ""};
}

}  // namespace

Program::Program(const std::string& question) : app_(std::make_unique<CLI::App>(question)) {
    app_->option_defaults()->always_capture_default();
}

Program::~Program() = default;

void Program::argument(const std::string& name, std::filesystem::path& value,
                       const std::string& what, Need need) {
    app_->add_option(name, value, what)->required(need == Need::required);
}

template <class Value>
void Program::option(const std::string& name, Value& value, const std::string& what) {
    CLI::Option* const added = app_->add_option(name, value, what);
    if constexpr (is_list<Value>) added->delimiter(',');
}

template <class Number>
void Program::count(const std::string& name, Number& value, const std::string& what) {
    app_->add_option(name, value, what)->check(positive());
}

void Program::choice(const std::string& name, std::string& value, std::vector<std::string> choices,
                     const std::string& what) {
    app_->add_option(name, value, what)->check(CLI::IsMember(std::move(choices)));
}

void Program::flag(const std::string& name, bool& value, const std::string& what) {
    app_->add_flag(name, value, what);
}

int Program::run(int argc, char** argv, const std::function<bool()>& work) {
    CLI11_PARSE(*app_, argc, argv);
    const std::string name = std::filesystem::path(argv[0]).filename();
    try {
        return work() ? 0 : 1;
    } catch (const Error& error) {
        fmt::print(stderr, "{}: {}\n", name, error.what());
        return static_cast<int>(error.exit_code());
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}: {}\n", name, error.what());
        return internal_error;
    }
}

template void Program::option(const std::string&, int64_t&, const std::string&);
template void Program::option(const std::string&, double&, const std::string&);
template void Program::option(const std::string&, std::string&, const std::string&);
template void Program::option(const std::string&, std::filesystem::path&, const std::string&);
template void Program::option(const std::string&, std::optional<int>&, const std::string&);
template void Program::option(const std::string&, std::vector<int64_t>&, const std::string&);
template void Program::option(const std::string&, std::vector<uint64_t>&, const std::string&);
template void Program::option(const std::string&, std::vector<double>&, const std::string&);
template void Program::option(const std::string&, std::vector<std::string>&, const std::string&);
template void Program::count(const std::string&, int&, const std::string&);
template void Program::count(const std::string&, int64_t&, const std::string&);

}  // namespace kinetome::bench
