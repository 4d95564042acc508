// One logger per run, handed to whoever speaks; no global one.
#pragma once

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/dist_sink.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace kinetome {

enum class LogFormat { text, json };

struct LogOptions {
    LogFormat format = LogFormat::text;
    bool quiet = false;            ///< warnings and errors only on the terminal
    std::filesystem::path file{};  ///< when not empty, every line also goes there, appended
    std::string prefix{};          ///< of every message: who speaks, such as "rank 3: "
};

/// Timed lines on standard error and, when asked, in a file. Copies share the sinks; thread-safe.
class Log {
  public:
    /// A log that drops everything (for tests and library use).
    Log();
    /// Throws CreateError when the log file cannot be written.
    explicit Log(const LogOptions& options);

    template <class... Arguments>
    void info(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
        line(spdlog::level::info, fmt::format(format, std::forward<Arguments>(arguments)...));
    }
    template <class... Arguments>
    void warning(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
        line(spdlog::level::warn, fmt::format(format, std::forward<Arguments>(arguments)...));
    }
    template <class... Arguments>
    void error(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
        line(spdlog::level::err, fmt::format(format, std::forward<Arguments>(arguments)...));
    }

    bool quiet() const { return quiet_; }
    /// Whether standard error is a terminal that may show a moving bar.
    bool on_terminal() const { return on_terminal_; }

    /// Adds a log file, appended to, for this log and its copies. Throws CreateError.
    void add_file(const std::filesystem::path& file);

  private:
    void line(spdlog::level::level_enum level, const std::string& text) const;

    std::shared_ptr<spdlog::sinks::dist_sink_mt> sinks_;
    std::shared_ptr<spdlog::logger> logger_;
    LogFormat format_ = LogFormat::text;
    std::string prefix_;
    bool quiet_ = false;
    bool on_terminal_ = false;
};

}  // namespace kinetome
