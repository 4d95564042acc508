#include "kinetome/run/key.h"

#include <catch2/catch.hpp>

using namespace kinetome;

TEST_CASE("keys differ when a name, a value or the place of a value differs", "[key]") {
    const StageKey key = StageKey().add("a", "1").add("b", "2");
    CHECK(key.digest() == StageKey().add("a", "1").add("b", "2").digest());
    CHECK(key.digest() != StageKey().add("a", "1").add("b", "3").digest());
    CHECK(key.digest() != StageKey().add("a", "1").add("c", "2").digest());
    CHECK(key.digest() != StageKey().add("a", "1").digest());
    CHECK(StageKey().add("a", "1b").digest() != StageKey().add("a1", "b").digest());
}

TEST_CASE("a key says which of its parts changed", "[key]") {
    const StageKey was = StageKey().add("option clusters", "250").add("gone", "x");
    const StageKey is = StageKey().add("option clusters", "300").add("fresh", "y");
    CHECK(is.difference_from(was) == "option clusters was 250, is 300; fresh is new; gone is gone");
    CHECK(was.difference_from(was).empty());
}

TEST_CASE("digests in a key are not printed", "[key]") {
    const StageKey was = StageKey().add("input frames", digest_of("a"));
    const StageKey is = StageKey().add("input frames", digest_of("b"));
    CHECK(is.difference_from(was) == "input frames changed");
}
