// Construction of a Capsule.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/indices.hpp"
#include "system/capsule.hpp"
#include "system/collocation.hpp"
#include "system/solids/rigid_tractions.hpp"

namespace tanktread::coupling {

namespace {

/// Returns the parameters with the space and the block of rows of every particle filled in.
CapsuleParameters placed(CapsuleParameters parameters, const spline::Space& space) {
  if (parameters.particles.size() == 1) parameters.particles.front().space = &space;
  place(parameters.particles);
  for (Particle& one : parameters.particles)
    one.by_traction = one.rigid && parameters.solvers.rigid_bodies == "first kind";
  return parameters;
}

bool slides(const Particle& particle) { return particle.slides(); }

std::optional<VelocityProjection> chosen_projection(const spline::Space& space, const Net& unstressed, const CapsuleParameters& of,
                                                    const Ranks& ranks) {
  if (of.solvers.projection == "collocation") return {};
  return VelocityProjection(space, unstressed, of.symmetry, of.solvers.direct, ranks);
}

/// Returns the mobility of each control point (velocity per force) for waves of one wave number k. A sheet with the surface shear viscosity eta in a
/// fluid has the mobility 1/(4 mu k + eta k^2) (velocity per force per area). k is the geometric mean of the wave number of the shortest wave on the
/// mesh and 1/(2 R_C).
Eigen::VectorXd mobilities(std::span<const Particle> particles, const Eigen::VectorXd& areas, double viscosity) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(areas.size());
  for (const Particle& one : particles) {
    const auto own = areas.segment(one.block.first_point, one.block.n_points);
    const double element = std::sqrt(own.sum() / one.block.n_elements), k = std::sqrt(std::numbers::pi / (2 * element * one.radius));
    if (!one.rigid)
      result.segment(one.block.first_point, one.block.n_points) = (4 * viscosity * k + one.material.viscosity.shear * k * k) * own;
  }
  return result.unaryExpr([](double m) { return m > 0 ? 1 / m : 0; });
}

}  // namespace

Capsule::Capsule(const spline::Space& space, const Net& unstressed, const Net& initial, const stokes::AmbientFlow& flow,
                 const CapsuleParameters& parameters, Ranks& ranks, Phases& phases, std::unique_ptr<Tube> tube)
    : space_(space),
      unstressed_(unstressed),
      rest_(initial),
      flow_(flow),
      parameters_(placed(parameters, space)),
      ranks_(ranks),
      phases_(phases),
      geometry_(space),
      mass_matrix_(space),
      membrane_(space, unstressed, materials(parameters_.particles)),
      tangent_(membrane_),
      projection_(chosen_projection(space, unstressed, parameters, ranks)),
      layer_(stokes::Layer::Kernel::single_layer, space, projection_ ? projection_->sites() : space.collocation, parameters.quadrature),
      collocation_(parameters.solvers.direct, parameters.symmetry),
      mass_(parameters.solvers.direct, parameters.symmetry),
      velocity_solver_(parameters.solvers.of(parameters.solvers.velocity)),
      step_solver_(parameters.solvers.of(parameters.solvers.implicit_step)),
      inner_solver_(parameters.solvers.of(parameters.solvers.velocity)),
      rigid_(parameters_.particles, initial, parameters.viscosity, parameters.quadrature),
      tube_(std::move(tube)) {
  surface::Symmetry& symmetry = parameters_.symmetry;
  if (symmetry.fundamental().empty()) symmetry = surface::Symmetry(space.n_points);
  const surface::Share share =
      surface::share(space, surface::partition_of_points(space, ranks.size(), symmetry.fundamental()), ranks.rank());
  own(share);
  ranks_.own(own_points_, symmetry);
  collocation_.factor(collocation_matrix(space));
  mass_.factor(mass_matrix_.update(unstressed));
  if (measure() == stokes::Measure::reference) mass_matrix_.release();
  nodal_.share(ranks.rank(), ranks.size(), symmetry.fundamental());
  make_layers();
  if (parameters.solvers.rigid_bodies == "first kind" && !rigid_.empty())
    tractions_ = std::make_unique<RigidTractions>(space, unstressed_, initial, particles(), parameters.viscosity, parameters.quadrature,
                                                  parameters.solvers, parameters.wall, tube_.get(), own_points_, ranks);
  if (std::ranges::any_of(particles(), [](const Particle& one) { return !one.rigid && one.material.viscosity.any(); }))
    viscous_.emplace(membrane_), linearised_viscous_.emplace(membrane_);
  if (std::ranges::any_of(particles(), [](const Particle& one) { return one.material.area_order > 0; })) {
    const Eigen::VectorXd areas = mass_matrix_.row_sums(unstressed);
    area_.emplace(membrane_, mobilities(particles(), areas, parameters_.viscosity));
    if (area_->empty()) area_.reset();
  }
  loads_ = Loads(particles(), own_elements_);
  if (by_sites() || parameters_.wall) sites_ = collocation_matrix(space);
  if (parameters_.cell) deform_cell(0);
  put_among_solids();
  if (tube_) {
    if (!tube_->fixed()) inner_radius_ = tube_->wall().outline.distance(tube_->wall().outline.centroid());
    tube_->set_reference(unstressed, measure(), measured_on_present(particles()));
    tube_->set_contrasts(viscosity_contrasts_of_points(particles()));
  }
  for (const Particle& particle : particles())
    volume0_.push_back(particle.kept_volume ? *particle.kept_volume : surface::volume(*particle.space, particle.block.rows(initial)));
  if (std::ranges::any_of(particles(), coupling::slides))
    interface_.emplace(space, unstressed, particles(), parameters.quadrature, own_points_, share.elements, collocation_, mass_.reference(), ranks_,
                       projection_ ? &*projection_ : nullptr);
}

Capsule::~Capsule() = default;

/// Constructs the layers at the points where velocities are evaluated, and separate layers for the Jacobian if these points are not the collocation
/// sites.
void Capsule::make_layers() {
  using stokes::Layer;
  const surface::Symmetry& symmetry = parameters_.symmetry;
  const std::vector<double> contrasts = viscosity_contrasts(particles());
  const auto make = [&](std::optional<Layer>& layer, Layer::Kernel kernel, const stokes::Sites& sites, const std::vector<double>& factor) {
    layer.emplace(kernel, space_, sites, parameters_.quadrature, factor);
  };
  layer_.set_reference(unstressed_, measured_on_present(particles()));
  layer_.set_symmetry(symmetry);
  if (projection_) {
    make(site_layer_, Layer::Kernel::single_layer, space_.collocation, {});
    site_layer_->set_reference(unstressed_);
  }
  if (!contrasts.empty()) make(double_layer_, Layer::Kernel::double_layer, projection_ ? projection_->sites() : space_.collocation, contrasts);
  if (!contrasts.empty() && projection_) make(site_double_layer_, Layer::Kernel::double_layer, space_.collocation, contrasts);
  const std::vector<int> everybody = projection_ ? indices(projection_->sites().size()) : symmetry.fundamental();
  if (parameters_.wall) layer_.set_wall(*parameters_.wall);
  if (parameters_.wall && double_layer_) double_layer_->set_wall(*parameters_.wall);
  layer_.share(ranks_.rank(), ranks_.size(), everybody);
  if (double_layer_) double_layer_->share(ranks_.rank(), ranks_.size(), everybody);
}

/// Sets the rank-owned points, and the elements whose integrals contribute to these points: the fundamental elements that touch the points or their
/// images. If an element is its own image, uses all elements that touch the points instead.
void Capsule::own(const surface::Share& share) {
  const surface::Symmetry& symmetry = parameters_.symmetry;
  const auto points = [&](int e) { return std::span<const int>(space_.elements[static_cast<std::size_t>(e)].points); };
  surface::FundamentalElements found = surface::fundamental_elements(symmetry, static_cast<int>(space_.elements.size()), points);
  const auto mine = [&](int a) { return std::ranges::binary_search(share.points, symmetry.source()[a]); };
  std::erase_if(found.element, [&](int e) { return std::ranges::none_of(points(e), mine); });
  own_points_ = share.points;
  folded_ = found.whole();
  own_elements_ = folded_ ? std::move(found.element) : share.elements;
}

}  // namespace tanktread::coupling
