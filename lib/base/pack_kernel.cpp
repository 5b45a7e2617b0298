#include "base/kernel.hpp"
#include "base/pack.hpp"

namespace tanktread {
inline namespace INSTRUCTIONS {

int pack_lanes() { return lanes; }

}  // namespace INSTRUCTIONS

KERNEL(int, pack_lanes, (), ())

}  // namespace tanktread
