#pragma once
// The plan: what a run has chosen, a line each.

#include <string>

#include "record/files/summary.hpp"
#include "scene/body.hpp"

namespace tanktread {

/// Unknowns, kernels, memory, scheme, and what the scene made superfluous. `body`: all that the scene has, on this many ranks.
output::Entries<std::string> plan(const Scene& scene, const Body& body, int ranks);

/// The same before a run. Throws UserError where the particles do not fit in where they start.
output::Entries<std::string> plan(const Scene& scene, int ranks);

/// A plan as it is printed.
std::string plan_text(const output::Entries<std::string>& plan);

}  // namespace tanktread
