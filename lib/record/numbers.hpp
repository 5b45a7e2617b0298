#pragma once
// Derived and dimensionless numbers of a scene.

#include <span>

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

}  // namespace tanktread
