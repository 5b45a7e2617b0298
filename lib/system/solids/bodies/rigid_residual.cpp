#include "system/solids/bodies/rigid_residual.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace tanktread::coupling {

namespace {

std::vector<spline::Block> blocks_of_bodies(std::span<const Particle> particles) {
  std::vector<spline::Block> blocks;
  for (const Particle& one : particles)
    if (one.rigid) blocks.push_back(one.block);
  return blocks;
}

/// Returns the quadrature of the residual, with a quarter of the tolerance down to 1e-6. The residual is a small difference of velocities, which is
/// integrated with the force density, so that the quadrature error of the residual is an error of forces and pressure drops. In trains of spheres at
/// the default tolerance, a quarter reduces the error of the pressure drop 3 to 5 times.
quadrature::Options for_residual(quadrature::Options options) {
  constexpr double share = 0.25, sharpest = 1e-6;
  options.tolerance = std::min(options.tolerance, std::max(share * options.tolerance, sharpest));
  return options;
}

}  // namespace

RigidResidual::RigidResidual(const spline::Space& space, const Net& unstressed, const Net& rest, const CapsuleParameters& parameters,
                             const FluidWalls& walls, const Ranks& ranks)
    : walls_(walls),
      between_(between_sites(space, rest, blocks_of_bodies(parameters.particles))),
      layers_(space, between_.sites, between_.values, unstressed, parameters, for_residual(parameters.quadrature), walls, ranks) {}

Net RigidResidual::integrated(const Net& x, const Net& load, const Net& v, Net flow) {
  layers_.set_shape(x, std::move(flow));
  const Net u = velocities(layers_, {.load = load, .density = v, .walls = walls_.respond(load, v, true), .ambient = true});
  return between_.weights * (between_.values * v - u);
}

double RigidResidual::ambient_correction(const Net& of_duct, const Net& f) const {
  const Tube& tube = *walls_.tube;
  if (tube.properties().parallel_flow) return 0;
  return -dot(between_.weights * (of_duct - between_.values * tube.in_flow().control_values), f) / tube.flow().flow_rate();
}

double RigidResidual::pressure_correction(const Net& of_duct, const Net& f, double work) const {
  return ambient_correction(of_duct, f) - work / walls_.tube->flow().flow_rate();
}

const WallResidual& RigidResidual::on_wall(const Net& f) {
  if (!on_wall_) on_wall_.emplace(*walls_.tube);
  on_wall_->set_load(f);
  return *on_wall_;
}

stokes::Evaluations RigidResidual::evaluations() const {
  const stokes::Evaluations sum = layers_.evaluations();
  return on_wall_ ? sum + on_wall_->evaluations() : sum;
}

}  // namespace tanktread::coupling
