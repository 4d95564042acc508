#include "kinetome/base/quote.h"

#include <catch2/catch.hpp>
#include <string>

using kinetome::quote_for_message;

TEST_CASE("a name with escape codes, quotes or bytes beyond ASCII cannot reach a terminal") {
    CHECK(quote_for_message("lfemur") == "'lfemur'");
    CHECK(quote_for_message("\x1b[31m") == "'\\x1b[31m'");
    CHECK(quote_for_message("a'b\\c") == "'a\\x27b\\x5cc'");
    CHECK(quote_for_message("\xc2\x9b\n") == "'\\xc2\\x9b\\x0a'");
    CHECK(quote_for_message(std::string("a\0b", 3)) == "'a\\x00b'");
    CHECK(quote_for_message("") == "''");
}

TEST_CASE("a name of a megabyte does not fill the log") {
    CHECK(quote_for_message(std::string(1000000, 'x'), 5) == "'xxxxx...'");
    CHECK(quote_for_message("xxxxx", 5) == "'xxxxx'");
}
