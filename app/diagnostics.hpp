#pragma once
// The series of a run: their names, units, descriptions, and one row of them.

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/body.hpp"
#include "coupling/capsule.hpp"
#include "motion/integrator.hpp"

namespace tanktread {

/// Name, unit and description of one column of `/series`.
struct Column {
  std::string name, unit, description;
};
const std::vector<Column>& columns();

/// Those of these names, for a particle of another kind that records the same.
std::vector<Column> named(const std::vector<Column>& all, std::initializer_list<std::string_view> names);

/// The value of one series in a row. Throws std::out_of_range where there is no such series.
double entry(const std::vector<Column>& columns, const std::vector<double>& row, std::string_view name);

/// One row, in the order of `columns`. Collective.
std::vector<double> row(const Scene& scene, const Body& body, coupling::Capsule& capsule, const motion::State& state,
                        const motion::StepReport& report, double wall_seconds, const coupling::Ranks& ranks);

/// Largest |v.n| over these collocation sites, over rate x R_C: zero when the shape is steady. In a tube of the velocity relative to the centroid's
/// along the tube, over the mean velocity.
double normal_velocity(const Scene& scene, const Body& body, const surface::Geometry& geometry, const motion::State& state,
                       std::span<const int> sites);

}  // namespace tanktread
