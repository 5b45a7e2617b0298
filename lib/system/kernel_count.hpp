#pragma once
// Work of all ranks together.

#include "stokes/kernels/kernels.hpp"
#include "system/ranks.hpp"

namespace tanktread::coupling {

/// Kernel evaluations of all ranks together, from each one's own. Collective.
stokes::Evaluations of_all(const stokes::Evaluations& own, const Ranks& ranks);

}  // namespace tanktread::coupling
