#pragma once
// Derived and dimensionless numbers of a scene.

#include <span>
#include <string>

#include "record/files/summary.hpp"
#include "scene/body.hpp"

namespace tanktread {

/// Derived or dimensionless number of a scene; NaN if it is not defined for the scene.
struct Number {
  const char *name, *unit, *description;
  double (*value)(const ParticleScene& particle_scene, const Body& body);
};
std::span<const Number> all_numbers();

/// Returns the derived and dimensionless numbers that are defined for this scene.
output::Entries<double> numbers(const Scene& scene, const Body& body);

/// Returns the derived and dimensionless numbers of a scene as the text of one line of the plan.
std::string numbers_text(const output::Entries<double>& numbers);

}  // namespace tanktread
