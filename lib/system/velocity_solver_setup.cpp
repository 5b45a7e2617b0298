// Construction of a VelocitySolver.

#include <algorithm>
#include <cassert>
#include <utility>

#include "system/velocity_solver.hpp"
#include "system/solids/bodies/rigid_tractions.hpp"

namespace tanktread::coupling {

namespace {

/// Returns the parameters with the space and the block of rows of every particle filled in, and with the trivial symmetry if none is set.
CapsuleParameters completed(CapsuleParameters parameters, const spline::Space& space) {
  if (parameters.particles.size() == 1) parameters.particles.front().space = &space;
  set_blocks(parameters.particles);
  if (parameters.symmetry.fundamental().empty()) parameters.symmetry = surface::Symmetry(space.n_points);
  return parameters;
}

/// Returns the motion of control points along interfaces; null if no control points slide.
std::unique_ptr<InterfaceMotion> interface_motion(const spline::Space& space, const CapsuleParameters& parameters, const Layout& layout,
                                                  const Targets& targets, const Membranes& membranes) {
  if (std::ranges::none_of(parameters.particles, &Particle::slides)) return {};
  return std::make_unique<InterfaceMotion>(space, membranes.unstressed(), parameters, layout, targets, membranes.mass());
}

}  // namespace

VelocitySolver::VelocitySolver(const spline::Space& space, const Net& unstressed, const Net& resting, const stokes::AmbientFlow& flow,
                               const CapsuleParameters& parameters, Phases& phases, std::unique_ptr<Tube> tube)
    : space_(space), resting_(resting), flow_(flow), parameters_(completed(parameters, space)), phases_(phases),
      layout_(space, parameters_.symmetry, phases),
      targets_(space, unstressed, parameters_, layout_),
      membranes_(space, unstressed, parameters_, layout_, phases),
      volumes_(space, resting, particles(), layout_, phases),
      layers_(space, unstressed, parameters_, layout_, targets_, phases),
      tube_(std::move(tube)),
      solids_(parameters_.solids ? std::make_unique<SolidResponse>(*parameters_.solids, space_, flow_) : nullptr),
      walls_{tube_.get(), solids_.get()},
      bodies_{RigidParticles(particles(), resting, parameters_.viscosity, parameters_.quadrature), {}, {}},
      interface_(interface_motion(space, parameters_, layout_, targets_, membranes_)),
      krylov_(parameters_.solvers.of(parameters_.solvers.velocity)) {
  assert(!tube_ || !targets_.projection());  // Tube computes its response only at collocation sites, not at the sites of a projection
  walls_.set_particles(membranes_.unstressed(), particles());
  if (std::ranges::any_of(particles(), &Particle::by_traction))
    bodies_.tractions = std::make_unique<RigidTractions>(space, membranes_.unstressed(), resting, parameters_, walls_, layout_.points(),
                                                         layout_.ranks());
  if (parameters_.cell || tube_) deform_cell(0);
}

VelocitySolver::~VelocitySolver() = default;

}  // namespace tanktread::coupling
