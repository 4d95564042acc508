// Whether this processor can run this build: the instruction set is fixed when compiling
// (KINETOME_ARCH), so that results do not change with the machine a job lands on.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinetome {

/// A group of instructions and the first level of the x86-64 psABI that demands it.
struct InstructionSet {
    std::string_view name;
    int level;  ///< 2, 3 or 4, for x86-64-v2 and so on
    bool supported;
};

/// What the psABI levels demand, and whether this processor has it.
std::vector<InstructionSet> processor_instruction_sets();

/// Names, with ", " between, of the sets that `architecture` ("x86-64-v3") demands and the
/// processor lacks. Empty for names that are not a psABI level, such as "native".
std::string missing_instruction_sets(std::string_view architecture,
                                     std::span<const InstructionSet> processor);

/// Throws UsageError with the missing instructions when this processor lacks what the build was
/// compiled for. Call first in main.
void require_build_architecture();

}  // namespace kinetome
