// The unknowns of VelocitySolver: the linear system for the velocity, and the tractions on rigid bodies.

#include <algorithm>
#include <cmath>
#include <memory>
#include <ranges>
#include <utility>

#include "base/formatted.hpp"
#include "system/velocity_solver.hpp"
#include "system/solids/bodies/rigid_tractions.hpp"
#include "system/solids/ducts/tube_system.hpp"

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

/// Returns the load that depends on the velocity v: viscous stresses of membranes, and loads of bodies with prescribed motion. No rows if there is no
/// such load.
Net VelocitySolver::velocity_load(const Net& x, const Net& v) {
  Net load = bodies_.rigid.prescribed() ? bodies_.rigid.completing_load(v) : Net();
  if (viscous()) load = load.size() > 0 ? Net(load + membranes_.viscous_load(x, v)) : membranes_.viscous_load(x, v);
  return load;
}

/// Returns B v with the operator B of (4.2), without the response of walls. `load`: velocity_load(x, v).
Net VelocitySolver::velocity_product(const Net& x, const Net& v, const Net& load) {
  if (!has_system()) return v;
  Net bv = v - targets_.serial_control_values(layers_.apply(x, v, load));
  bodies_.rigid.complete(v, bv);
  return bv;
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

/// Solves P B P v = rhs for v, with the operator B of (4.2), the projection P (2.8) of `volume`, and P rhs = rhs. In a tube, B includes the response
/// of the wall to v if the option Solvers/tube is `schur`. With other values of this option, solve_blocks() solves for v and the wall tractions
/// together. The initial guess is rhs if `guess` is empty or there are rigid bodies, and otherwise `guess`. `error`: see Evaluation::solve.
Net VelocitySolver::solve_velocity(const Net& x, const Net& f, const VolumeProjection& volume, const Net& rhs, const Net& guess, double error) {
  const auto clock = phases_.time("velocity system");
  const auto least = [](const Particle& one) { return one.radius * std::sqrt(static_cast<double>(one.block.n_points)); };
  const double allowed = error * std::ranges::min(particles() | std::views::transform(least));  // allowed error of v in the Euclidean norm
  const Eigen::VectorXd right = flat(rhs);
  const double tolerance = std::max(parameters_.solvers.tolerance, std::min(1e-2, allowed / right.norm()));
  const bool by_inverse = uses_inverse(error, tolerance);
  layers_.assemble(x, viscous(), by_inverse);
  if (!eliminates_walls()) return solve_blocks(x, f, volume, rhs);
  const auto apply = [&](Net v) {
    volume.apply(v);
    const Net load = velocity_load(x, v);
    Net bv = velocity_product(x, v, load);
    if (walls_.any()) {
      Net u = targets_.zero();
      add_walls(load, v, false, u);
      bv -= targets_.serial_control_values(u);
    }
    volume.apply(bv);
    return bv;
  };
  Eigen::VectorXd v = flat(guess.size() > 0 && bodies_.rigid.empty() ? guess : rhs);
  const LinearSystem system{velocity_blocks(particles()), on_nets(x.rows(), apply),
                            by_inverse ? on_nets(x.rows(), inverse_) : velocity_preconditioner(x)};
  const SolveReport report = krylov_.solve(system, right, v, tolerance);
  record_solve(report, v.allFinite(), tolerance);
  Net solution = as_net(v);
  volume.apply(solution);
  return solution;
}

/// Solves for the velocity v, the wall traction f^D, the pressure drop dp (2.5)-(2.7) and the volume multipliers (2.8) in one system. The right-hand
/// side rhs = v_inf - (1/mu) R^-1 A f is also the initial guess of v.
Net VelocitySolver::solve_blocks(const Net& x, const Net& f, const VolumeProjection& volume, const Net& rhs) {
  const auto load = [&](const Net& v) { return velocity_load(x, v); };
  const auto unbounded = [&](const Net& v, const Net& load_of_v) { return velocity_product(x, v, load_of_v); };
  const auto control_values = [&](const Net& at_sites) { return targets_.collocation().solve(at_sites); };
  const double unit = tube_->wall().radius() / parameters_.viscosity;
  const TubeSystem system{*tube_, load, unbounded, control_values, volume, unit};
  const Eigen::VectorXd right = system.right_hand_side(rhs, f);
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(right.size());
  unknowns.head(rhs.size()) = right.head(rhs.size());
  const LinearSystem linear = system.linear_system(velocity_blocks(particles()), parameters_.solvers.tube);
  const SolveReport report = krylov_.solve(linear, right, unknowns, parameters_.solvers.tolerance);
  record_solve(report, unknowns.allFinite(), parameters_.solvers.tolerance);
  Net v = as_net(unknowns.head(rhs.size()));
  volume.apply(v);
  return v;
}

/// Returns the velocity of deformable particles for the unknowns y of solve_tractions(); 0 in the rows of bodies.
Net VelocitySolver::deformable_velocity(const VolumeProjection& volume, const Net& y) const {
  Net v = y;
  clear_rigid(particles(), v);
  volume.apply(v);
  return v;
}

/// Returns the load that depends on the unknowns y of solve_tractions(): tractions on bodies, and viscous loads of membranes. `v`:
/// deformable_velocity() for y.
Net VelocitySolver::traction_load(const Net& x, const Net& y, const Net& v) {
  Net load = viscous() ? membranes_.viscous_load(x, v) : Net::Zero(y.rows(), 3);
  for (const Particle& one : particles())
    if (one.rigid) one.block.rows(load) = -one.block.rows(y);
  return load;
}

/// Returns the product of the operator of solve_tractions() and the unknowns y, see RigidTractions::Surroundings.
Net VelocitySolver::traction_product(const Net& x, const VolumeProjection& volume, const Net& y, const Net& caused) {
  const Net v = deformable_velocity(volume, y), load = traction_load(x, y, v);
  Net other = viscous() || caused.size() == 0 ? load : Net();  // load whose induced velocity is not contained in `caused`
  if (viscous() && caused.size() > 0) clear_rigid(particles(), other);
  Net u = layers_.apply(x, v, other);
  if (caused.size() > 0) u += caused;
  add_walls(load, v, false, u);
  if (bodies_.tractions->all_rigid()) return u;
  Net all = v - targets_.serial_control_values(u);
  volume.apply(all);
  for (const Particle& one : particles())
    if (one.rigid) one.block.rows(all) = one.block.rows(u);
  return all;
}

/// Solves for the tractions on rigid bodies (2.40) and the velocity v of deformable particles (2.52). Returns the velocity of all particles. `flow`:
/// part of the velocity that does not depend on these unknowns. Adds the loads that depend on the unknowns to the load
/// of `found`, and sets its response of a tube.
Net VelocitySolver::solve_tractions(const Net& x, const VolumeProjection& volume, const Net& flow, SolvedShape& found) {
  const auto clock = phases_.time("tractions");
  layers_.assemble(x, viscous(), false);
  // Copies of x and volume, because RigidTractions keeps these functions for moment().
  const auto product = [this, x, volume](const Net& y, const Net& caused) { return traction_product(x, volume, y, caused); };
  const auto load = [this, x, volume, known = found.load](const Net& y) {
    return Net(known + traction_load(x, y, deformable_velocity(volume, y)));
  };
  std::vector<Vec3> centres;
  std::vector<RigidDrive> driven;
  for (std::size_t p = 0; p < particles().size(); ++p)
    if (bodies_.rigid.is_rigid(p)) centres.push_back(bodies_.rigid.centre(p)), driven.push_back(bodies_.rigid.given(p));
  const bool responds = layers_.repeats() || walls_.any() || has_system();
  const RigidTractions::Solution& solution =
      bodies_.tractions->solve(x, centres, driven, flow_, RigidTractions::Surroundings{flow, responds, product, load});
  Net v = deformable_velocity(volume, solution.unknowns);
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
