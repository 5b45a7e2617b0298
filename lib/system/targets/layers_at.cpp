#include "system/targets/layers_at.hpp"

#include <span>

namespace tanktread::coupling {

Net velocities(LayersAt& at, const Sources& sources, Net* control_values) {
  Net u = at.of_particles(sources.load, sources.density);
  if (control_values && sources.ambient) *control_values = at.ambient_control_values();
  if (sources.ambient && !(control_values && control_values->size() > 0)) u = at.ambient() + u;
  if (sources.walls) at.add_walls(*sources.walls, u);
  return u;
}

LayersBetween::LayersBetween(const spline::Space& space, const stokes::Sites& sites, const Eigen::SparseMatrix<double>& values,
                             const Net& unstressed, const CapsuleParameters& parameters, const quadrature::Options& quadrature,
                             const FluidWalls& walls, const Ranks& ranks)
    : values_(values), walls_(walls), ranks_(ranks),
      layers_(space, sites, unstressed, parameters.particles, quadrature, parameters.viscosity, parameters.medium.get()) {}

void LayersBetween::set_shape(const Net& x, Net ambient) {
  layers_.set_shape(x);
  x_ = x, ambient_ = std::move(ambient);
}

Net LayersBetween::of_particles(const Net& load, const Net& density) {
  return ranks_.divided<Net>(static_cast<int>(values_.rows()), 3,
                             [&](std::span<const int> own, Net& u) { layers_.add(load, density, own, u); });
}

void LayersBetween::add_walls(const FluidWalls::Response& walls, Net& u) {
  if (!walls_.any()) return;
  u += ranks_.divided<Net>(static_cast<int>(values_.rows()), 3,
                           [&](std::span<const int> own, Net& part) { walls_.add_velocity_at(values_, x_, walls, own, part); });
}

}  // namespace tanktread::coupling
