#include "kinetome/base/log.h"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <unistd.h>

#include <cstdlib>

#include "descriptor.h"
#include "kinetome/base/file.h"
#include "log_line.h"

namespace kinetome {
namespace {

constexpr const char* wipe_line = "\r\x1b[K";

bool bar_can_move() {
    const char* terminal = std::getenv("TERM");
    return ::isatty(STDERR_FILENO) == 1 && terminal && std::string_view(terminal) != "dumb";
}

}  // namespace

Log::Log() : sinks_(std::make_shared<spdlog::sinks::dist_sink_mt>()) {
    logger_ = std::make_shared<spdlog::logger>("kinetome", sinks_);
    logger_->flush_on(spdlog::level::info);
}

Log::Log(const LogOptions& options) : Log() {
    format_ = options.format;
    prefix_ = options.prefix;
    quiet_ = options.quiet;
    on_terminal_ = format_ == LogFormat::text && bar_can_move();
    auto terminal = std::make_shared<spdlog::sinks::stderr_sink_mt>();
    terminal->set_formatter(line_formatter(format_, on_terminal_ ? wipe_line : ""));
    if (quiet_) terminal->set_level(spdlog::level::warn);
    sinks_->add_sink(std::move(terminal));
    if (!options.file.empty()) add_file(options.file);
}

void Log::add_file(const std::filesystem::path& file) {
    // spdlog would try five times, and then not tell the reason.
    if (!Descriptor(file, O_WRONLY | O_APPEND | O_CREAT, 0666).valid()) {
        throw create_error("write the log file", file, errno);
    }
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string());
    sink->set_formatter(line_formatter(format_));
    sinks_->add_sink(std::move(sink));
}

void Log::line(spdlog::level::level_enum level, const std::string& text) const {
    logger_->log(level, spdlog::string_view_t(prefix_ + text));
}

}  // namespace kinetome
