#include "system/solids/ducts/wall_residual.hpp"

#include <algorithm>
#include <span>

#include "system/solids/ducts/duct.hpp"
#include "system/targets/collocation.hpp"
#include "system/targets/layer_pair.hpp"

namespace tanktread::coupling {

namespace {

quadrature::Options for_wall_residual(quadrature::Options options) {
  constexpr double sharpness = 1e-2, coarsest = 1e-8;  // sharpness: factor of the tolerance of integrals over the wall, because pressures are large.
                                                       // coarsest: upper limit of this product
  options.tolerance = std::clamp(sharpness * options.tolerance, 1e-12, coarsest);
  return options;
}

}  // namespace

WallResidual::WallResidual(Tube& tube) : WallResidual(tube, between_sites(tube.wall().space, tube.wall().net)) {}

WallResidual::WallResidual(Tube& tube, const BetweenSites& between)
    : tube_(tube), at_(between.values * tube.wall().net), weights_(between.weights),
      layer_(stokes::Layer::Kernel::single_layer, tube.wall().space, between.sites, for_wall_residual(tube.duct().wall().quadrature())) {
  if (const auto& cell = tube.cell()) layer_.repeat(*cell);
  layer_.set_shape(tube.wall().net);
}

void WallResidual::set_load(const Net& f) {
  const Tube::Response response = tube_.respond(f);
  const Duct& duct = tube_.duct();
  const Wall& wall = duct.wall();
  const Net by_pressure = response.pressure_drop * duct.velocity_per_pressure_drop(at_);
  const Net u = wall.points().ranks().divided<Net>(static_cast<int>(at_.rows()), 3, [&](std::span<const int> own, Net& velocity) {
    Net of_wall(at_.rows(), 3);
    layer_.apply(wall.on_space(response.wall_traction), own, of_wall);
    for (const int i : own) velocity.row(i) = by_pressure.row(i) - of_wall.row(i) / duct.viscosity();
    tube_.particles().add(f, {}, {.at = at_, .own = {own.begin(), own.end()}}, velocity);
  });
  velocity_ = wall.from_space(Net(weights_ * u)), flow_ = tube_.disturbed_flow_rate(f, {}, response);
}

double WallResidual::work(const Tube::Response& of) const { return dot(of.wall_traction, velocity_) - of.pressure_drop * flow_; }

}  // namespace tanktread::coupling
