#include "kinetome/base/log.h"

#include <catch2/catch.hpp>
#include <ctime>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <thread>
#include <vector>

#include "captured_error_stream.h"
#include "kinetome/base/error.h"

using namespace kinetome;
using Catch::Contains;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

const std::string time_pattern = R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z)";

}  // namespace

TEST_CASE("text lines begin with the time in UTC and the level") {
    ::setenv("TZ", "Asia/Tokyo", 1);
    ::tzset();
    const auto lines = lines_of(captured_error_stream([] {
        const Log log(LogOptions{});
        log.info("{} of {}", 3, 7);
        log.warning("careful");
        log.error("broken");
    }));
    REQUIRE(lines.size() == 3);
    CHECK(std::regex_match(lines[0], std::regex(time_pattern + " info 3 of 7")));
    CHECK(std::regex_match(lines[1], std::regex(time_pattern + " warning careful")));
    CHECK(std::regex_match(lines[2], std::regex(time_pattern + " error broken")));

    std::tm logged{};
    REQUIRE(::strptime(lines[0].c_str(), "%Y-%m-%dT%H:%M:%S", &logged));
    CHECK(std::abs(std::difftime(::timegm(&logged), std::time(nullptr))) < 60);
    ::unsetenv("TZ");
    ::tzset();
}

TEST_CASE("every JSON line can be read back, whatever a file was named") {
    std::vector<std::string> messages{
        "plain",          R"(quotes " and \ backslashes)", "two\nlines\r\n\tand a tab", "{}",
        "žluťoučký 馬 🐎", std::string("zero \0 byte", 11)};
    std::string control;
    for (char c = 1; c < 0x20; ++c) control += c;
    messages.push_back(control + "\x7f\x1b[31m");
    const auto lines = lines_of(captured_error_stream([&] {
        const Log log(LogOptions{.format = LogFormat::json});
        for (const std::string& message : messages) log.info("{}", message);
        log.error("broken");
    }));
    REQUIRE(lines.size() == messages.size() + 1);
    for (size_t i = 0; i < messages.size(); ++i) {
        const auto json = nlohmann::json::parse(lines[i]);
        CHECK(json.at("message") == messages[i]);
        CHECK(json.at("level") == "info");
        CHECK(std::regex_match(json.at("time").get<std::string>(), std::regex(time_pattern)));
        CHECK(json.size() == 3);
    }
    CHECK(nlohmann::json::parse(lines.back()).at("level") == "error");
}

TEST_CASE("bytes that are not UTF-8 do not make a JSON line unreadable") {
    const std::string replacement = "\xEF\xBF\xBD";
    const std::vector<std::pair<std::string, size_t>> bad{
        {"\xff", 1},         {"\xc3", 1},         {"\xc0\xaf", 2},         {"\xe2\x82", 2},
        {"\xed\xa0\x80", 3}, {"\xe0\x80\x80", 3}, {"\xf4\x90\x80\x80", 4}, {"\xf0\x80\x80\x80", 4},
        {"\x80", 1}};
    const auto lines = lines_of(captured_error_stream([&] {
        const Log log(LogOptions{.format = LogFormat::json});
        for (const auto& [bytes, replaced] : bad) log.info("a{}b", bytes);
        for (const auto& [bytes, replaced] : bad) log.info("{}", bytes);
    }));
    REQUIRE(lines.size() == 2 * bad.size());
    for (size_t i = 0; i < bad.size(); ++i) {
        std::string expected;
        for (size_t k = 0; k < bad[i].second; ++k) expected += replacement;
        CHECK(nlohmann::json::parse(lines[i]).at("message") == "a" + expected + "b");
        CHECK(nlohmann::json::parse(lines[bad.size() + i]).at("message") == expected);
    }
}

TEST_CASE("a quiet log shows warnings alone, but its file holds everything") {
    const TemporaryFolder folder;
    const std::string shown = captured_error_stream([&] {
        const Log log(LogOptions{.quiet = true, .file = folder / "log"});
        log.info("information");
        log.warning("warning");
    });
    CHECK_THAT(shown, Contains("warning") && !Contains("information"));
    CHECK_THAT(read_file(folder / "log"), Contains("info information") && Contains("warning"));
}

TEST_CASE("lines of one of several processes say which one speaks") {
    const TemporaryFolder folder;
    const std::string shown = captured_error_stream([&] {
        Log log(LogOptions{.file = folder / "log", .prefix = "rank 3: "});
        log.warning("careful");
    });
    CHECK_THAT(shown, Contains(" warning rank 3: careful\n"));
    CHECK_THAT(read_file(folder / "log"), Contains(" warning rank 3: careful\n"));
}

TEST_CASE("a log file is appended to, and what is logged is in it at once") {
    const TemporaryFolder folder;
    folder.write("log", "of an earlier run\n");
    captured_error_stream([&] {
        Log log(LogOptions{});
        const Log copy = log;
        log.info("before");
        log.add_file(folder / "log");
        copy.info("after");
        const std::string text = read_file(folder / "log");
        CHECK_THAT(text, Catch::StartsWith("of an earlier run\n") && Contains("after\n"));
        CHECK_THAT(text, !Contains("before"));
    });
}

TEST_CASE("a log file that cannot be written is reported, not skipped") {
    const TemporaryFolder folder;
    folder.write("file", "");
    Log log;
    CHECK_THROWS_AS(log.add_file(folder / "file" / "log"), CreateError);
    CHECK_THROWS_WITH(log.add_file(folder / "file" / "log"), Contains("Not a directory"));
    CHECK_THROWS_AS(log.add_file(folder.path()), CreateError);
}

TEST_CASE("two logs in one process do not hear each other") {
    const TemporaryFolder folder;
    Log first, second;
    first.add_file(folder / "first");
    second.add_file(folder / "second");
    first.info("one");
    CHECK(read_file(folder / "second").empty());
    CHECK_THAT(read_file(folder / "first"), Contains("one"));
}

TEST_CASE("a default log says nothing") {
    CHECK(captured_error_stream([] { Log().error("unheard"); }).empty());
}

TEST_CASE("lines of several threads are not mixed") {
    const TemporaryFolder folder;
    Log log;
    log.add_file(folder / "log");
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&log, t] {
            for (int i = 0; i < 200; ++i) log.info("{}", std::string(100, char('a' + t)));
        });
    }
    for (std::thread& thread : threads) thread.join();
    const auto lines = lines_of(read_file(folder / "log"));
    CHECK(lines.size() == 800);
    const std::regex whole(time_pattern + " info (a{100}|b{100}|c{100}|d{100})");
    for (const std::string& line : lines) REQUIRE(std::regex_match(line, whole));
}
