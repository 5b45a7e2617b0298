// The system of VelocitySolver at one shape, and its solution: the velocity system, and the tractions on rigid bodies.

#include <algorithm>
#include <cmath>
#include <memory>
#include <ranges>
#include <utility>

#include "base/formatted.hpp"
#include "system/equations/particles.hpp"
#include "system/equations/volumes.hpp"
#include "system/equations/walls.hpp"
#include "system/solids/bodies/body_preconditioner.hpp"
#include "system/solids/bodies/rigid_tractions.hpp"
#include "system/velocity_solver.hpp"

namespace tanktread::coupling {

namespace {

constexpr double few_iterations = 1e-5;  // relative residual above which a solve with an approximate inverse takes about three iterations

/// The targets on the particles at the shape x, with exact or assembled layers.
class LayersAtTargets : public LayersAt {
 public:
  /// `bodies`: single layer of the bodies whose unknown is the traction; null if there are none, or on a lattice.
  LayersAtTargets(VelocitySolver& solver, Net x, BodyLayer* bodies) : solver_(solver), x_(std::move(x)), bodies_(bodies) {}

  Net ambient() override {
    const stokes::AmbientFlow& flow = solver_.flow();
    const Tube* const tube = solver_.walls().tube;
    return tube && flow.duct() ? Net(flow.amplitude() * tube->in_flow().ambient) : flow.velocities(solver_.targets().values() * x_);
  }
  Net ambient_control_values() override {
    const bool at_sites = std::ranges::any_of(solver_.particles(), &Particle::by_traction);  // rows that need the velocity at the sites
    return at_sites || flow_at_targets(solver_.walls(), solver_.flow()) ? Net() : solver_.flow().velocities(x_);
  }
  Net of_particles(const Net& load, const Net& density) override {
    Net others = load, on_bodies;
    if (bodies_ && load.size() > 0) clear_rigid(solver_.particles(), others), on_bodies = load - others;
    Net u = solver_.layers().apply(x_, density, others.isZero(0) ? Net() : others);
    if (on_bodies.size() > 0 && !on_bodies.isZero(0)) u += bodies_->velocity(-on_bodies);
    return u;
  }
  void add_walls(const FluidWalls::Response& walls, Net& u) override { solver_.walls().add_velocity(walls, solver_.targets(), u); }

 private:
  VelocitySolver& solver_;
  Net x_;
  BodyLayer* bodies_;
};

/// Velocities of particles on a lattice minus those of their images in the cell, whose velocities are the unknowns.
class OutOfCell : public Equation {
 public:
  OutOfCell(std::span<const Particle> particles, std::vector<CellShift> shifts) : particles_(particles), shifts_(std::move(shifts)) {}
  void add_velocity(const BlockVector&, Given given, Net& v) const override {
    for (std::size_t p = 0; p < shifts_.size() && given == Given::included; ++p)
      particles_[p].block.rows(v).rowwise() += shifts_[p].velocity.transpose();
  }

 private:
  std::span<const Particle> particles_;
  std::vector<CellShift> shifts_;
};

}  // namespace

/// Adds an iterative solve to the counts. Throws RunFailure if it did not converge although its solution is finite (`finite`).
void VelocitySolver::record_solve(const SolveReport& report, bool finite, double tolerance) {
  ++counts_.velocity_solves;
  counts_.velocity_iterations += report.iterations;
  counts_.most_velocity_iterations = std::max<long>(counts_.most_velocity_iterations, report.iterations);
  const auto contrast = [](const Particle& particle) { return std::abs(std::log(particle.viscosity_ratio)); };
  const double ratio = std::ranges::max_element(particles(), {}, contrast)->viscosity_ratio;
  const std::string system =
      bodies_.rigid.empty() ? formatted("the velocity at viscosity ratio %g", ratio) : "the velocity of rigid bodies and others";
  if (finite) require_convergence(report, system, tolerance);
}

/// Returns the layout of the unknowns: those of the particles and, unless they are eliminated, of the wall and of the volumes.
std::shared_ptr<const Layout> VelocitySolver::unknowns(bool multipliers) {
  std::shared_ptr<const Layout>& kept = solving_.unknowns[multipliers];
  if (kept) return kept;
  std::vector<Block> blocks = blocks_of_particles(particles());
  if (!eliminates_walls()) std::ranges::copy(DuctWall::unknowns(*tube_, parameters_.viscosity), std::back_inserter(blocks));
  if (multipliers) blocks.push_back(VolumeConstraint::unknowns(particles()));
  return kept = std::make_shared<const Layout>(solving_.added.after(std::move(blocks)));
}

/// Returns the system at the shape x in the cell, to which the walls and the rigid bodies must be set. `known`: virtual work of the loads at x,
/// computed here if it has no rows. `multipliers`: whether the multipliers of the volumes are unknowns. `shifts`: from the particles in the cell to
/// the particles themselves; empty without a lattice.
std::shared_ptr<VelocitySolver::AtShape> VelocitySolver::at_shape(const Net& x, WorkOfLoads& known, bool multipliers,
                                                                  std::span<const CellShift> shifts) {
  const auto at = std::make_shared<AtShape>(AtShape{.x = x, .volume = {}, .system = {}});
  layers_.discard_rows();
  System::Equations equations;
  const std::shared_ptr<const Layout> layout = unknowns(multipliers);
  if (std::ranges::any_of(particles(), [](const Particle& one) { return !one.rigid; })) {
    Net load = load_and_projection(x, known, &at->volume);
    equations.push_back(std::make_unique<DeformableVelocities>(particles(), membranes_, x, std::move(load), layers_.has_double()));
  }
  BodyLayer* const bodies = bodies_.tractions ? &bodies_.tractions->layer() : nullptr;
  if (bodies) equations.push_back(std::make_unique<BodyTractions>(particles(), *bodies, layers_.repeats()));
  else if (!bodies_.rigid.empty()) equations.push_back(std::make_unique<BodyDensities>(particles(), bodies_.rigid));
  if (at->volume.active()) equations.push_back(std::make_unique<VolumeConstraint>(at->volume, multipliers ? layout.get() : nullptr));
  if (!eliminates_walls())
    equations.push_back(std::make_unique<DuctWall>(*tube_, *layout, parameters_.solvers.tube));
  else if (walls_.any())
    equations.push_back(std::make_unique<EliminatedWalls>(walls_, phases_));
  if (!solving_.added.empty()) {
    Net shape = x;
    for (std::size_t p = 0; p < shifts.size(); ++p) particles()[p].block.rows(shape).rowwise() += shifts[p].position.transpose();
    if (!shifts.empty()) equations.push_back(std::make_unique<OutOfCell>(particles(), std::vector(shifts.begin(), shifts.end())));
    for (auto& one : solving_.added.at(shape, *layout)) at->added.push_back(one.get()), equations.push_back(std::move(one));
  }
  at->system.emplace(layout, std::move(equations), std::make_shared<LayersAtTargets>(*this, x, layers_.repeats() ? nullptr : bodies),
                     [this](const Net& u) {
                       const auto clock = phases_.time("projection");
                       return targets_.control_values(u);
                     });
  return at;
}

std::string VelocitySolver::plan(const Net& shape) {
  WorkOfLoads known;
  const bool iterated = bodies_.tractions ? bodies_respond() : has_velocity_system();
  return at_shape(place(shape), known, keeps_multipliers())->system->plan() + (iterated ? "; iterated" : "; without an iteration");
}

/// Returns whether the inverse of use_inverse() is the preconditioner of a solve that allows the error `error`, with the relative residual
/// `tolerance`. It is the result of an iteration, so that the solver must admit preconditioners that are not linear.
bool VelocitySolver::uses_inverse(double error, double tolerance) const {
  const Krylov& krylov = solving_.krylov;
  const bool suitable = solving_.inverse && bodies_.rigid.empty() && eliminates_walls() && krylov.uses_own_preconditioner() && krylov.flexible();
  return suitable && error > 0 && tolerance > few_iterations;
}

/// Returns the preconditioner of the velocity system at x, from inverses for isolated rigid bodies and for the thin films between bodies. Empty if no
/// such inverses are stored. Valid until the bodies move.
Apply VelocitySolver::velocity_preconditioner(const Net& x) {
  if (!bodies_.isolated) bodies_.isolated = std::make_unique<OneBodyInverses>(particles(), bodies_.rigid, resting_, parameters_.quadrature);
  if (bodies_.isolated->empty()) return {};
  const auto films = std::make_shared<FilmInverses>(particles(), *bodies_.isolated, bodies_.rigid, x,
                                                    [&](std::span<const int> sites) { return layers_.double_rows(sites); });
  return on_nets(x.rows(), [this, films](Net y) {
    bodies_.isolated->evaluate_at_sites(y);
    films->add(y);
    bodies_.isolated->solve(bodies_.rigid, y);
    return y;
  });
}

/// Solves the system for its right-hand side `right` and returns the unknowns. The initial guess is `right` if `guess` is empty or there are rigid
/// bodies, and otherwise `guess`. `error`: see Evaluation::solve.
BlockVector VelocitySolver::solve_velocity(AtShape& at, const BlockVector& right, const Net& guess, double error) {
  const auto clock = phases_.time("velocity system");
  const auto least = [](const Particle& one) { return one.radius * std::sqrt(static_cast<double>(one.block.n_points)); };
  const double allowed = error * std::ranges::min(particles() | std::views::transform(least));  // allowed error of v in the Euclidean norm
  const double tolerance = std::max(parameters_.solvers.tolerance, std::min(1e-2, allowed / right.norm()));
  const bool by_inverse = uses_inverse(error, tolerance);
  layers_.assemble(at.x, viscous() || !solving_.added.empty(), by_inverse);
  if (by_inverse) at.system->set_inverse_of_particles(on_nets(at.x.rows(), solving_.inverse));
  else if (eliminates_walls()) at.system->set_inverse_of_particles(velocity_preconditioner(at.x));
  const bool guessed = guess.size() > 0 && bodies_.rigid.empty();
  BlockVector y = at.system->projected(at.system->of(guessed ? guess : Net(System::particles(right))));
  record_solve(at.system->solve(solving_.krylov, right, y, tolerance), y.allFinite(), tolerance);
  return y;
}

/// Sets the load of `found` for the unknowns y. Adds the loads of the equations of the program to the known loads and to the forces on rigid bodies,
/// and sets the solution.
void VelocitySolver::set_load(const AtShape& at, const BlockVector& y, SolvedShape& found) {
  found.load = at.system->load(y, &found.added_work);
  if (solving_.added.empty()) return;
  found.solution = y;
  if (found.added_work.size() == 0) return;
  push_bodies(at.x, found.added_work);
  if (found.virtual_work.work.size() == 0) found.virtual_work = work_of_loads(at.x);
  found.virtual_work.work += found.added_work;
  clear_rigid(particles(), found.virtual_work.work);
}

/// Solves for the tractions on rigid bodies (2.40) and the velocity v of deformable particles (2.52). Returns the velocity of all particles. Sets the
/// load, the unknowns and the response of a tube of `found`.
Net VelocitySolver::solve_tractions(const std::shared_ptr<AtShape>& at, SolvedShape& found) {
  const auto clock = phases_.time("tractions");
  layers_.assemble(at->x, viscous(), false);
  std::vector<Vec3> centres;
  std::vector<RigidDrive> driven;
  for (std::size_t p = 0; p < particles().size(); ++p)
    if (bodies_.rigid.is_rigid(p)) centres.push_back(bodies_.rigid.centre(p)), driven.push_back(bodies_.rigid.given(p));
  const RigidTractions::Solution& solution = bodies_.tractions->solve(
      at->x, centres, driven, flow_, RigidTractions::Surroundings{std::shared_ptr<const System>(at, &*at->system), at->added, bodies_respond()});
  BlockVector y = at->system->projected(at->system->of(solution.unknowns));
  y.numbers().tail(solution.added.size()) = solution.added;
  Net v = System::particles(y);
  clear_rigid(particles(), v);
  auto body = solution.bodies.begin();
  for (std::size_t p = 0; p < particles().size(); ++p)
    if (bodies_.rigid.is_rigid(p)) bodies_.rigid.set_motion(p, body->motion, body->force, body->torque, v), ++body;
  set_load(*at, y, found);
  found.unknowns = v;
  for (const SolveReport& report : bodies_.tractions->reports()) record_solve(report, v.allFinite(), parameters_.solvers.tolerance);
  if (tube_) found.response = tube_->respond(found.load, v, solution.pressure_correction);
  return v;
}

Mat3 VelocitySolver::moment_by_traction(std::size_t p) {
  const Mat3 moment = bodies_.tractions->moment(static_cast<std::size_t>(std::ranges::count_if(
      std::span(particles()).first(p), [](const Particle& one) { return one.rigid.has_value(); })));
  for (const SolveReport& report : bodies_.tractions->reports()) record_solve(report, true, parameters_.solvers.tolerance);
  return -moment;
}

}  // namespace tanktread::coupling
