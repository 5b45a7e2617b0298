#include "base/instruction_set.hpp"

#include <array>
#include <cstdlib>

#include "base/errors.hpp"
#include "base/pack.hpp"

namespace tanktread {
namespace {

constexpr std::array<const char*, n_instruction_sets> names{"baseline", "avx2", "avx512"};  // in the order of the enumeration
static_assert(static_cast<std::size_t>(InstructionSet::avx512) + 1 == n_instruction_sets);

InstructionSet widest() {
#ifdef SEVERAL_INSTRUCTION_SETS
  if (__builtin_cpu_supports("x86-64-v4")) return InstructionSet::avx512;
  if (__builtin_cpu_supports("x86-64-v3")) return InstructionSet::avx2;
#endif
  return InstructionSet::baseline;
}

InstructionSet chosen() {
  const char* const wish = std::getenv("TANKTREAD_INSTRUCTIONS");
  const auto most = static_cast<std::size_t>(widest());
  if (!wish || !*wish) return widest();
  for (std::size_t k = 0; k <= most; ++k)
    if (std::string(wish) == names[k]) return static_cast<InstructionSet>(k);
  std::string allowed = names[0];
  for (std::size_t k = 1; k <= most; ++k) allowed += std::string(", ") + names[k];
  throw UserError("TANKTREAD_INSTRUCTIONS: " + allowed + " (on this processor, with this build), not '" + wish + "'");
}

}  // namespace

InstructionSet instruction_set() {
  static const InstructionSet set = chosen();
  return set;
}

std::string instructions() {
  return std::string(names[static_cast<std::size_t>(instruction_set())]) + ", " + std::to_string(pack_lanes()) + " numbers at a time";
}

}  // namespace tanktread
