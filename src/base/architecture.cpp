// This file must run on the processors it turns away, so it is compiled for the oldest ones.
#pragma GCC target("arch=x86-64")

#include "kinetome/base/architecture.h"

#include "kinetome/base/error.h"

namespace kinetome {

std::vector<InstructionSet> processor_instruction_sets() {
    __builtin_cpu_init();
    const auto is = [](int answer) { return answer != 0; };
    return {
        {"CMPXCHG16B", 2, is(__builtin_cpu_supports("cmpxchg16b"))},
        {"LAHF-SAHF", 2, is(__builtin_cpu_supports("lahf_lm"))},
        {"POPCNT", 2, is(__builtin_cpu_supports("popcnt"))},
        {"SSE3", 2, is(__builtin_cpu_supports("sse3"))},
        {"SSSE3", 2, is(__builtin_cpu_supports("ssse3"))},
        {"SSE4.1", 2, is(__builtin_cpu_supports("sse4.1"))},
        {"SSE4.2", 2, is(__builtin_cpu_supports("sse4.2"))},
        {"AVX", 3, is(__builtin_cpu_supports("avx"))},
        {"AVX2", 3, is(__builtin_cpu_supports("avx2"))},
        {"BMI1", 3, is(__builtin_cpu_supports("bmi"))},
        {"BMI2", 3, is(__builtin_cpu_supports("bmi2"))},
        {"F16C", 3, is(__builtin_cpu_supports("f16c"))},
        {"FMA", 3, is(__builtin_cpu_supports("fma"))},
        {"LZCNT", 3, is(__builtin_cpu_supports("lzcnt"))},
        {"MOVBE", 3, is(__builtin_cpu_supports("movbe"))},
        {"OSXSAVE", 3, is(__builtin_cpu_supports("osxsave"))},
        {"AVX512F", 4, is(__builtin_cpu_supports("avx512f"))},
        {"AVX512BW", 4, is(__builtin_cpu_supports("avx512bw"))},
        {"AVX512CD", 4, is(__builtin_cpu_supports("avx512cd"))},
        {"AVX512DQ", 4, is(__builtin_cpu_supports("avx512dq"))},
        {"AVX512VL", 4, is(__builtin_cpu_supports("avx512vl"))},
    };
}

std::string missing_instruction_sets(std::string_view architecture,
                                     std::span<const InstructionSet> processor) {
    constexpr std::string_view prefix = "x86-64-v";
    if (architecture.size() != prefix.size() + 1 || !architecture.starts_with(prefix)) return {};
    const int level = architecture.back() - '0';
    std::string missing;
    for (const InstructionSet& set : processor) {
        if (set.supported || set.level > level) continue;
        if (!missing.empty()) missing += ", ";
        missing += set.name;
    }
    return missing;
}

void require_build_architecture() {
    const std::string missing =
        missing_instruction_sets(KINETOME_ARCH, processor_instruction_sets());
    if (missing.empty()) return;
    throw UsageError("this build is for " KINETOME_ARCH " processors, and this one lacks " +
                     missing +
                     ": run it on a newer node, or build it for this one with "
                     "-DKINETOME_ARCH=native");
}

}  // namespace kinetome
