#include "kinetome/base/progress.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <thread>
#include <vector>

#include "captured_error_stream.h"

using namespace kinetome;
using namespace std::chrono_literals;
using Catch::Contains;

namespace {

auto line_count(const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
}

}  // namespace

TEST_CASE("progress is told with count, share, rate and time left") {
    CHECK(describe_progress(1200, 5000, "frames", 4) ==
          "1200 of 5000 frames (24.0 %), 300.0 frames/s, 13 s left");
    CHECK(describe_progress(1, 1000, "clips", 10) ==
          "1 of 1000 clips (0.1 %), 0.1 clips/s, 2 h 46 min left");
    CHECK(describe_progress(10, 100, "clips", 10) ==
          "10 of 100 clips (10.0 %), 1.0 clips/s, 1 min 30 s left");
}

TEST_CASE("progress can be told at the very beginning, and when the total is unknown") {
    CHECK(describe_progress(0, 100, "clips", 0) == "0 of 100 clips (0.0 %), 0.0 clips/s");
    CHECK(describe_progress(30, 0, "clips", 10) == "30 clips, 3.0 clips/s");
}

TEST_CASE("off a terminal there is a line at each interval and one at the end, without bars") {
    const std::string text = captured_error_stream([] {
        const Log log(LogOptions{});
        Progress progress(log, "features", 3, "clips", 0s);
        for (int i = 0; i < 3; ++i) progress.advance();
    });
    CHECK(line_count(text) == 4);
    CHECK_THAT(text, Contains("info features: 2 of 3 clips (66.7 %)"));
    CHECK_THAT(text, Contains("info features: 3 clips in "));
    CHECK(text.find_first_of("\r\x1b") == std::string::npos);
}

TEST_CASE("a loop shorter than the interval leaves one line in a cluster's log") {
    const std::string text = captured_error_stream([] {
        const Log log(LogOptions{});
        Progress progress(log, "features", 1000, "clips");
        for (int i = 0; i < 1000; ++i) progress.advance();
    });
    CHECK(line_count(text) == 1);
    CHECK_THAT(text, Contains("features: 1000 clips in "));
}

TEST_CASE("advances of several threads are all counted") {
    const std::string text = captured_error_stream([] {
        const Log log(LogOptions{});
        Progress progress(log, "features", 40'000, "frames");
        std::vector<std::thread> threads;
        for (int t = 0; t < 4; ++t) {
            threads.emplace_back([&progress] {
                for (int i = 0; i < 1000; ++i) progress.advance(10);
            });
        }
        for (std::thread& thread : threads) thread.join();
    });
    CHECK_THAT(text, Contains("features: 40000 frames in "));
}

TEST_CASE("a loop that an exception ended is not reported as finished") {
    const std::string text = captured_error_stream([] {
        const Log log(LogOptions{});
        try {
            Progress progress(log, "features", 3, "clips");
            progress.advance();
            throw std::runtime_error("failed");
        } catch (const std::runtime_error&) {
        }
    });
    CHECK(text.empty());
}

TEST_CASE("a quiet run shows no progress, on a terminal or off") {
    if (!has_terminals()) return;
    const auto run = [] {
        const Log log(LogOptions{.quiet = true});
        Progress progress(log, "features", 3, "clips", 0s);
        for (int i = 0; i < 3; ++i) {
            std::this_thread::sleep_for(110ms);
            progress.advance();
        }
    };
    CHECK(captured_error_stream(run).empty());
    CHECK(captured_terminal(run).empty());
}

TEST_CASE("on a terminal a bar moves on one line, and log lines wipe it out") {
    if (!has_terminals()) return;
    const std::string shown = captured_terminal([] {
        const Log log(LogOptions{});
        Progress progress(log, "features", 4, "clips");
        std::this_thread::sleep_for(210ms);
        progress.advance(2);
        log.warning("in between");
        progress.advance(2);
    });
    // Half of the bar; then the line that replaces it; then the last line.
    const size_t bar = shown.find("\r\x1b[Kfeatures [============            ] 2 of 4 clips");
    const size_t warning = shown.find("\r\x1b[K2", bar + 1);
    const size_t end = shown.find("features: 4 clips in ");
    CHECK(bar != std::string::npos);
    CHECK(shown.find("warning in between\r\n") > warning);
    CHECK(warning > bar);
    CHECK(end > warning);
    CHECK(end != std::string::npos);
    CHECK(line_count(shown) == 2);
}

TEST_CASE("JSON lines are never interrupted by a bar, even on a terminal") {
    if (!has_terminals()) return;
    const std::string shown = captured_terminal([] {
        const Log log(LogOptions{.format = LogFormat::json});
        Progress progress(log, "features", 2, "clips", 0s);
        progress.advance();
    });
    CHECK(line_count(shown) == 2);
    CHECK_THAT(shown, Catch::StartsWith("{\"time\":") && !Contains("\x1b"));
}
