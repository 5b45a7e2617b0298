#pragma once
// The gaps between the particles of a run.

#include <optional>
#include <vector>

#include "app/diagnostics.hpp"
#include "app/member.hpp"
#include "coupling/ranks.hpp"

namespace tanktread {

/// On a lattice, `cell`, particles meet images of each other and of themselves too.

/// Throws UserError, which names the two and their gap, where two particles meet in their initial shapes, or one is inside of another.
void check_apart(const std::vector<Member>& members, const std::optional<stokes::PeriodicCell>& cell);

/// The smallest gap between any two particles at x, to 1e-7 of the largest R_C. Ranks share the pairs. Collective.
Nearest smallest_gap(const std::vector<Member>& members, const Net& x, const coupling::Ranks& ranks, const std::optional<stokes::PeriodicCell>& cell);

/// Width of the film beside each element of particle p at x, on its nested space, as far as its mesh has to know: elements of the first mesh are
/// short enough beside wider ones.
std::vector<double> films(const std::vector<Member>& members, std::size_t p, const Net& x);

}  // namespace tanktread
