#pragma once
// What a kernel needs to be compiled for several sets of instructions: its functions live in a namespace INSTRUCTIONS of their room,
// and KERNEL makes the room's own function, which calls the one of the set in use.

#include "base/instruction_set.hpp"
#include "base/register.hpp"

/// The function of the room: result type, name, parameters and arguments in parentheses.
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
