// The unknowns of VelocitySolver: the linear system for the velocity, and the tractions on rigid bodies.

#include <algorithm>
#include <cmath>
#include <memory>
#include <ranges>
#include <utility>

#include "base/formatted.hpp"
#include "system/block_system.hpp"
#include "system/velocity_solver.hpp"
#include "system/solids/bodies/rigid_tractions.hpp"

namespace tanktread::coupling {

namespace {
constexpr double few_iterations = 1e-5;  // relative residual above which a solve with an approximate inverse takes about three iterations
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

/// Returns the velocities in the unknowns y of the particles: y, with zero in the rows of bodies whose unknown is the traction.
Net VelocitySolver::velocities_in(const Net& y) const {
  Net v = y;
  if (bodies_.tractions) clear_rigid(particles(), v);
  return v;
}

/// Returns the load that depends on the unknowns y of the particles: viscous stresses of membranes, loads of bodies with prescribed motion (2.23),
/// and tractions on bodies (2.40). No rows if there is no such load.
Net VelocitySolver::dependent_load(const Net& x, const Net& y) {
  Net load;
  const auto add = [&load](Net part) { load = load.size() > 0 ? Net(load + part) : std::move(part); };
  if (viscous()) add(membranes_.viscous_load(x, velocities_in(y)));
  if (bodies_.rigid.prescribed() && !bodies_.tractions) add(bodies_.rigid.completing_load(y));
  if (!bodies_.tractions) return load;
  if (load.size() == 0) load = Net::Zero(y.rows(), 3);
  for (const Particle& one : particles())
    if (one.rigid) one.block.rows(load) = -one.block.rows(y);
  return load;
}

/// Returns B y for the unknowns y of all particles and the load dependent_load(x, y). A row is an equation of one of three kinds:
///
///   deformable particle                  v - R^-1 u       (4.2)
///   body whose unknown is w              (2.23), see RigidParticles::complete
///   body whose unknown is the traction   u at the sites   (2.40)
///
/// u is the velocity that y and its load cause, including the response of walls that are eliminated. `caused`: the part of u due to the tractions on
/// bodies, if it is known already; otherwise empty.
Net VelocitySolver::particle_rows(const Net& x, const Net& y, const Net& load, const Net& caused) {
  if (is_explicit() && !bodies_.tractions) return y;  // y causes no velocity
  const Net v = velocities_in(y);
  Net other = load;  // load whose velocity is not contained in `caused`
  if (caused.size() > 0) clear_rigid(particles(), other);
  Net u = layers_.apply(x, v, other.isZero(0) ? Net() : other);
  if (caused.size() > 0) u += caused;
  add_walls(load, v, false, u);
  if (bodies_.tractions && bodies_.tractions->all_rigid()) return u;
  Net rows = v - targets_.serial_control_values(u);
  if (!bodies_.tractions) {
    bodies_.rigid.complete(v, rows);
    return rows;
  }
  for (const Particle& one : particles())
    if (one.rigid) one.block.rows(rows) = one.block.rows(u);
  return rows;
}

/// Returns the system for the unknowns of all particles at the shape x and, unless they are eliminated, those of the wall and of the volumes. The
/// result refers to this object, x and `volume`.
BlockSystem VelocitySolver::block_system(const Net& x, const VolumeProjection& volume) {
  BlockSystem system{.load = [this, &x](const Net& y) { return dependent_load(x, y); },
                     .particles = [this, &x](const Net& y, const Net& load) { return particle_rows(x, y, load, {}); },
                     .control_values = [this](const Net& at_sites) { return targets_.collocation().solve(at_sites); },
                     .volume = volume,
                     .multipliers = keeps_multipliers()};
  if (!eliminates_walls()) system.tube = tube_.get(), system.unit = tube_->wall().radius() / parameters_.viscosity;
  return system;
}

/// Returns whether the inverse of use_inverse() is the preconditioner of a solve that allows the error `error`, with the relative residual
/// `tolerance`. It is the result of an iteration, so that the solver must admit preconditioners that are not linear.
bool VelocitySolver::uses_inverse(double error, double tolerance) const {
  const bool suitable = inverse_ && bodies_.rigid.empty() && eliminates_walls() && krylov_.uses_own_preconditioner() && krylov_.flexible();
  return suitable && error > 0 && tolerance > few_iterations;
}

/// Returns the preconditioner of the velocity system at x, from inverses for isolated rigid bodies and for the thin films between bodies. Empty if no
/// such inverses are stored. Valid until the bodies move.
Apply VelocitySolver::velocity_preconditioner(const Net& x) {
  if (!bodies_.isolated) bodies_.isolated.emplace(particles(), bodies_.rigid, resting_, parameters_.quadrature);
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

/// Solves the BlockSystem for the velocities at x and returns the velocity of the particles. `rhs`: v_inf - (1/mu) R^-1 A f, which
/// includes the response to the load f of walls that are eliminated. The initial guess is rhs if `guess` is empty or there are rigid bodies, and
/// otherwise `guess`. `error`: see Evaluation::solve.
Net VelocitySolver::solve_velocity(const Net& x, const Net& f, const VolumeProjection& volume, const Net& rhs, const Net& guess, double error) {
  const auto clock = phases_.time("velocity system");
  const auto least = [](const Particle& one) { return one.radius * std::sqrt(static_cast<double>(one.block.n_points)); };
  const double allowed = error * std::ranges::min(particles() | std::views::transform(least));  // allowed error of v in the Euclidean norm
  BlockSystem system = block_system(x, volume);
  const Eigen::VectorXd right = system.right_hand_side(rhs, f);
  const double tolerance = std::max(parameters_.solvers.tolerance, std::min(1e-2, allowed / right.norm()));
  const bool by_inverse = uses_inverse(error, tolerance);
  layers_.assemble(x, viscous(), by_inverse);
  if (by_inverse) system.of_particles = on_nets(x.rows(), inverse_);
  else if (eliminates_walls()) system.of_particles = velocity_preconditioner(x);
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(right.size());
  unknowns.head(rhs.size()) = flat(guess.size() > 0 && bodies_.rigid.empty() ? guess : as_net(right.head(rhs.size())));
  const SolveReport report =
      krylov_.solve(system.linear_system(velocity_blocks(particles()), parameters_.solvers.tube), right, unknowns, tolerance);
  record_solve(report, unknowns.allFinite(), tolerance);
  Net v = as_net(unknowns.head(rhs.size()));
  volume.apply(v);
  return v;
}

/// Solves for the tractions on rigid bodies (2.40) and the velocity v of deformable particles (2.52). Returns the velocity of all particles. `flow`:
/// part of the velocity that does not depend on these unknowns. Adds the loads that depend on the unknowns to the load
/// of `found`, and sets its response of a tube.
Net VelocitySolver::solve_tractions(const Net& x, const VolumeProjection& volume, const Net& flow, SolvedShape& found) {
  const auto clock = phases_.time("tractions");
  layers_.assemble(x, viscous(), false);
  // The functions contain copies of x and volume, because RigidTractions keeps them for moment().
  const auto projected = [volume](Net y) { return volume.applied(std::move(y)); };
  const auto product = [this, x, projected](const Net& given, const Net& caused) {
    const Net y = projected(given);
    return projected(particle_rows(x, y, dependent_load(x, y), caused));
  };
  const auto load = [this, x, projected, known = found.load](const Net& y) { return Net(known + dependent_load(x, projected(y))); };
  std::vector<Vec3> centres;
  std::vector<RigidDrive> driven;
  for (std::size_t p = 0; p < particles().size(); ++p)
    if (bodies_.rigid.is_rigid(p)) centres.push_back(bodies_.rigid.centre(p)), driven.push_back(bodies_.rigid.given(p));
  const bool responds = layers_.repeats() || walls_.any() || !is_explicit();
  const RigidTractions::Solution& solution =
      bodies_.tractions->solve(x, centres, driven, flow_, RigidTractions::Surroundings{flow, responds, product, load});
  Net v = velocities_in(projected(solution.unknowns));
  auto body = solution.bodies.begin();
  for (std::size_t p = 0; p < particles().size(); ++p)
    if (bodies_.rigid.is_rigid(p)) bodies_.rigid.set_motion(p, body->motion, body->force, body->torque, v), ++body;
  found.load = load(solution.unknowns);
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
