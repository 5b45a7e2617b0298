#pragma once
// Work of all ranks together.

#include "coupling/ranks.hpp"
#include "stokes/kernels.hpp"

namespace tanktread::coupling {

/// Kernel evaluations of all ranks together, from each one's own. Collective.
stokes::Evaluations of_all(const stokes::Evaluations& own, const Ranks& ranks);

}  // namespace tanktread::coupling
