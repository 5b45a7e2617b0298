#pragma once
// Compilation of kernels for several instruction sets. Each kernel function is compiled once per instruction set, in a nested namespace whose name is
// the macro INSTRUCTIONS (for example avx2). The macro KERNEL defines a function in the outer namespace that calls the version for the instruction
// set in use.

#include "base/instruction_set.hpp"
#include "base/register.hpp"

/// Defines the function of the module that calls the kernel for the instruction set in use. Arguments: result type, name, parameters in parentheses,
/// arguments in parentheses.
#if defined(SEVERAL_INSTRUCTION_SETS)
#define KERNEL(result, function, parameters, arguments)                                \
  namespace avx2 {                                                                     \
  result function parameters;                                                          \
  }                                                                                    \
  namespace avx512 {                                                                   \
  result function parameters;                                                          \
  }                                                                                    \
  result function parameters {                                                         \
    if (instruction_set() == InstructionSet::avx512) return avx512::function arguments; \
    if (instruction_set() == InstructionSet::avx2) return avx2::function arguments;     \
    return baseline::function arguments;                                               \
  }
#elif defined(ONE_OF_SEVERAL_INSTRUCTION_SETS)
#define KERNEL(result, function, parameters, arguments)
#else
#define KERNEL(result, function, parameters, arguments) \
  result function parameters { return INSTRUCTIONS::function arguments; }
#endif
