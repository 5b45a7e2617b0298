#pragma once
// The instructions that kernels run with. Kernels are the source files *_kernel; where the program is built for any processor of a family, each
// is compiled for several sets of instructions.

#include <string>

namespace tanktread {

enum class InstructionSet { baseline, avx2, avx512 };

/// The widest that this processor has of those that the kernels are compiled for, or the one that the environment variable TANKTREAD_INSTRUCTIONS
/// names: baseline, avx2 or avx512. Throws UserError if it names another, or one that the processor or the program lacks.
InstructionSet instruction_set();

/// Its name and the width of its registers, for readers of a plan.
std::string instructions();

}  // namespace tanktread
