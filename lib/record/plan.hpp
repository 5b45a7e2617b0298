#pragma once
// Plan of a run: the methods and sizes that it has chosen, one line each.

#include <string>

#include "record/files/summary.hpp"
#include "scene/body.hpp"

namespace tanktread {

/// Returns the plan: unknowns, kernels, memory, scheme, and the computations that are skipped because the scene does not need them. `body`: all
/// particles as one body. `ranks`: number of ranks.
output::Entries<std::string> plan(const Scene& scene, const Body& body, int ranks);

/// Returns the plan of a scene before a run. Throws UserError if the particles overlap, or do not fit into the scene, in their initial positions.
output::Entries<std::string> plan(const Scene& scene, int ranks);

/// Returns the text of the plan, to be printed.
std::string plan_text(const output::Entries<std::string>& plan);

}  // namespace tanktread
