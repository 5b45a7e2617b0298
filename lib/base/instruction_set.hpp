#pragma once
// Instruction set that the kernels use. Kernels are the functions in source files whose names end with _kernel. In a build for all processors of a
// family, each kernel is compiled for several instruction sets.

#include <cstddef>
#include <string>

namespace tanktread {

/// The instruction sets, narrowest first. A new one is also added to `names` and widest() (instruction_set.cpp), KERNEL (kernel.hpp), register_bytes
/// (register.hpp), the compiler flags (module.cmake) and tests/style/kernels.py.
enum class InstructionSet { baseline, avx2, avx512 };
constexpr std::size_t n_instruction_sets = 3;

/// Returns the instruction set in use: the one that the environment variable TANKTREAD_INSTRUCTIONS names (baseline, avx2 or avx512), or otherwise
/// the widest one that the processor has and the kernels are compiled for. Throws UserError if the variable has any other value, or names an
/// instruction set that the processor does not have or the kernels are not compiled for.
InstructionSet instruction_set();

/// Returns the name of the instruction set and the number of doubles in a register, for the plan that a run prints.
std::string instructions();

}  // namespace tanktread
