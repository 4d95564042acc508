#include "kinetome/base/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

namespace kinetome {
namespace {

using namespace std::chrono_literals;

constexpr auto bar_interval = 200ms;

size_t terminal_columns() {
    winsize size{};
    const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : 80;
}

std::string bar(double fraction) {
    constexpr size_t width = 24;
    const auto filled = static_cast<size_t>(std::clamp(fraction, 0.0, 1.0) * double(width));
    return fmt::format("[{:<{}}]", std::string(filled, '='), width);
}

void to_terminal(const std::string& text) {
    std::fputs(("\r\x1b[K" + text).c_str(), stderr);
    std::fflush(stderr);
}

std::string duration_text(double seconds) {
    const auto whole = std::llround(seconds);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

}  // namespace

std::string describe_progress(int64_t done, int64_t total, std::string_view unit, double seconds) {
    const double rate = seconds > 0 ? double(done) / seconds : 0;
    if (total <= 0) return fmt::format("{} {}, {:.1f} {}/s", done, unit, rate, unit);
    std::string text = fmt::format("{} of {} {} ({:.1f} %), {:.1f} {}/s", done, total, unit,
                                   100.0 * double(done) / double(total), rate, unit);
    if (rate > 0) text += fmt::format(", {} left", duration_text(double(total - done) / rate));
    return text;
}

Progress::Progress(const Log& log, std::string title, int64_t total, std::string unit,
                   Clock::duration line_interval)
    : log_(log),
      title_(std::move(title)),
      unit_(std::move(unit)),
      total_(total),
      bar_(log.on_terminal() && !log.quiet()),
      interval_(bar_ ? bar_interval : line_interval),
      exceptions_(std::uncaught_exceptions()),
      started_(Clock::now()),
      shown_(started_) {}

Progress::~Progress() {
    try {
        if (bar_visible_) to_terminal("");
        if (std::uncaught_exceptions() > exceptions_) return;
        const double seconds = seconds_until(Clock::now());
        const int64_t done = done_;
        log_.info("{}: {} {} in {:.1f} s, {:.1f} {}/s", title_, done, unit_, seconds,
                  seconds > 0 ? double(done) / seconds : 0, unit_);
    } catch (...) {  // a report that cannot be written must not end the program
    }
}

void Progress::advance(int64_t count) {
    const int64_t done = done_ += count;
    const Clock::time_point now = Clock::now();
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || now - shown_ < interval_) return;  // another thread is at it, or it is too early
    shown_ = now;
    show(done, now);
}

void Progress::show(int64_t done, Clock::time_point now) {
    const std::string text = describe_progress(done, total_, unit_, seconds_until(now));
    if (!bar_) {
        log_.info("{}: {}", title_, text);
        return;
    }
    const double fraction = total_ > 0 ? double(done) / double(total_) : 0;
    const std::string line = fmt::format("{} {} {}", title_, bar(fraction), text);
    to_terminal(line.substr(0, terminal_columns() - 1));
    bar_visible_ = true;
}

double Progress::seconds_until(Clock::time_point now) const {
    return std::chrono::duration<double>(now - started_).count();
}

}  // namespace kinetome
