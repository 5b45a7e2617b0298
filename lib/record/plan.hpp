#pragma once
// The plan: what a run has chosen, a line each.

#include <span>
#include <string>

#include "record/files/summary.hpp"
#include "scene/body.hpp"

namespace tanktread {

/// A number that a scene has, or not: not a number.
struct Number {
  const char *name, *unit, *description;
  double (*value)(const Scene& scene, const Body& body);
};
std::span<const Number> all_numbers();

/// Those that this scene has.
output::Entries<double> numbers(const Scene& scene, const Body& body);

/// The same in one line of the plan.
std::string numbers_text(const output::Entries<double>& numbers);

/// Unknowns, kernels, memory, scheme, and what the scene made superfluous. `body`: all that the scene has, on this many ranks.
output::Entries<std::string> plan(const Scene& scene, const Body& body, int ranks);

/// The same before a run. Throws UserError where the particles do not fit in where they start.
output::Entries<std::string> plan(const Scene& scene, int ranks);

/// A plan as it is printed.
std::string plan_text(const output::Entries<std::string>& plan);

}  // namespace tanktread
