#include "kinetome/base/architecture.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace kinetome;

namespace {

/// A processor with everything but some sets.
std::vector<InstructionSet> processor_without(std::vector<std::string_view> names) {
    auto sets = processor_instruction_sets();
    for (InstructionSet& set : sets) {
        set.supported = std::find(names.begin(), names.end(), set.name) == names.end();
    }
    return sets;
}

}  // namespace

TEST_CASE("a processor that lacks instructions of the build is told which") {
    const auto old = processor_without({"AVX2", "FMA", "AVX512F"});
    CHECK(missing_instruction_sets("x86-64-v2", old).empty());
    CHECK(missing_instruction_sets("x86-64-v3", old) == "AVX2, FMA");
    CHECK(missing_instruction_sets("x86-64-v4", old) == "AVX2, FMA, AVX512F");
}

TEST_CASE("a processor that has all is let in") {
    CHECK(missing_instruction_sets("x86-64-v4", processor_without({})).empty());
}

TEST_CASE("an instruction set that is not a level of the psABI is not judged") {
    const auto old = processor_without({"AVX2"});
    for (const char* name : {"native", "x86-64", "znver3", "", "x86-64-v3x"}) {
        CHECK(missing_instruction_sets(name, old).empty());
    }
}

TEST_CASE("this processor runs this build") {
    CHECK_NOTHROW(require_build_architecture());
}
