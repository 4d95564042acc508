#include "log_line.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <iterator>

#include "json_text.h"

namespace kinetome {
namespace {

/// RFC 3339 in UTC, to the millisecond.
std::string timestamp(spdlog::log_clock::time_point time) {
    using namespace std::chrono;
    const auto milliseconds_since_epoch = floor<milliseconds>(time.time_since_epoch());
    const auto seconds_since_epoch = floor<seconds>(milliseconds_since_epoch);
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z",
                       fmt::gmtime(static_cast<std::time_t>(seconds_since_epoch.count())),
                       (milliseconds_since_epoch - seconds_since_epoch).count());
}

class LineFormatter : public spdlog::formatter {
  public:
    LineFormatter(LogFormat format, std::string before)
        : format_(format), before_(std::move(before)) {}

    void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override {
        const auto out = std::back_inserter(line);
        const std::string time = timestamp(message.time);
        const spdlog::string_view_t name = spdlog::level::to_string_view(message.level);
        const std::string_view level(name.data(), name.size());
        const std::string_view text(message.payload.data(), message.payload.size());
        if (format_ == LogFormat::json) {
            fmt::format_to(out, "{}{{\"time\":\"{}\",\"level\":\"{}\",\"message\":{}}}\n", before_,
                           time, level, json_text(text));
        } else {
            fmt::format_to(out, "{}{} {} {}\n", before_, time, level, text);
        }
    }

    std::unique_ptr<spdlog::formatter> clone() const override {
        return std::make_unique<LineFormatter>(format_, before_);
    }

  private:
    LogFormat format_;
    std::string before_;
};

}  // namespace

std::unique_ptr<spdlog::formatter> line_formatter(LogFormat format, std::string before) {
    return std::make_unique<LineFormatter>(format, std::move(before));
}

}  // namespace kinetome
