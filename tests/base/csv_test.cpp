#include "kinetome/base/csv.h"

#include <catch2/catch.hpp>

#include "kinetome/base/error.h"

using namespace kinetome;

TEST_CASE("any field comes back from the file it was written to") {
    const std::vector<std::string> hostile = {
        "plain",  "",   "a,b", "say \"no\"", "two\nlines", "return\r\nhere",
        " ends ", "\"", "'x",  "<script>",   "=cmd()",     "ümläut"};
    std::string text;
    append_csv_line(text, {"name", "value"});
    for (const std::string& field : hostile) append_csv_line(text, {field, "1"});
    const std::vector<CsvRecord> records = parse_csv(text, "hostile.csv");
    REQUIRE(records.size() == hostile.size() + 1);
    for (size_t i = 0; i < hostile.size(); ++i) {
        CHECK(records[i + 1].fields == std::vector<std::string>{hostile[i], "1"});
    }
}

TEST_CASE("no text is taken for a formula, and all texts come back") {
    for (const char* text : {"=1+1", "+1", "-1", "@x", "\tx", "\rx"}) {
        CHECK(csv_text(text).front() == '\'');
        CHECK(from_csv_text(csv_text(text)) == text);
    }
    for (const char* text : {"", "walk", "1-2", "a=b"}) CHECK(csv_text(text) == text);
    CHECK(from_csv_text("'tis") == "'tis");
}

TEST_CASE("fields with CRLF, quotes and line breaks are read as RFC 4180 says") {
    const auto records = parse_csv("a,\"b\r\nc\",\"d\"\"e\"\r\n\r\nf,,g", "file.csv");
    REQUIRE(records.size() == 2);
    CHECK(records[0].fields == std::vector<std::string>{"a", "b\r\nc", "d\"e"});
    CHECK(records[1].fields == std::vector<std::string>{"f", "", "g"});
    CHECK(records[0].line == 1);
    CHECK(records[1].line == 4);
}

TEST_CASE("a broken quote is refused, naming the line where it began") {
    using Catch::Matchers::Contains;
    CHECK_THROWS_WITH(parse_csv("a,b\n\"open,\nstill", "x.csv"), Contains("x.csv:2: "));
    CHECK_THROWS_WITH(parse_csv("a,b\nc,d\"e\n", "x.csv"), Contains("x.csv:2: "));
    CHECK_THROWS_WITH(parse_csv("\"a\"b\n", "x.csv"), Contains("x.csv:1: "));
    CHECK_THROWS_AS(parse_csv("\"", "x.csv"), InputError);
}
