#pragma once
// Plan of a run: the methods and sizes that it has chosen, one line each, and the derived and dimensionless numbers of its scene.

#include <span>
#include <string>

#include "record/files/summary.hpp"
#include "scene/body.hpp"

namespace tanktread {

/// Derived or dimensionless number of a scene; NaN if it is not defined for the scene.
struct Number {
  const char *name, *unit, *description;
  double (*value)(const ParticleScene& scene, const Body& body);
};
std::span<const Number> all_numbers();

/// Returns the derived and dimensionless numbers that are defined for this scene.
output::Entries<double> numbers(const Scene& scene, const Body& body);

/// Returns the derived and dimensionless numbers of a scene as the text of one line of the plan.
std::string numbers_text(const output::Entries<double>& numbers);

/// Returns the plan: unknowns, kernels, memory, scheme, and the computations that are skipped because the scene does not need them. `body`: all
/// particles as one body. `ranks`: number of ranks.
output::Entries<std::string> plan(const Scene& scene, const Body& body, int ranks);

/// Returns the plan of a scene before a run. Throws UserError if the particles overlap, or do not fit into the scene, in their initial positions.
output::Entries<std::string> plan(const Scene& scene, int ranks);

/// Returns the text of the plan, to be printed.
std::string plan_text(const output::Entries<std::string>& plan);

}  // namespace tanktread
