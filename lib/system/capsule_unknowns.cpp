// The unknowns of Capsule: the linear system for the velocity, and the tractions on rigid bodies.

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/formatted.hpp"
#include "system/capsule.hpp"
#include "system/solids/rigid_tractions.hpp"
#include "system/solvers/tube_system.hpp"

namespace tanktread::coupling {

void Capsule::note(const SolveReport& report, const Eigen::VectorXd& v) {
  ++work_.velocity_solves;
  work_.velocity_iterations += report.iterations;
  work_.most_velocity_iterations = std::max<long>(work_.most_velocity_iterations, report.iterations);
  const auto contrast = [](const Particle& particle) { return std::abs(std::log(particle.viscosity_ratio)); };
  const double ratio = std::ranges::max_element(particles(), {}, contrast)->viscosity_ratio;
  const std::string system = rigid_.empty() ? formatted("the velocity at viscosity ratio %g", ratio) : "the velocity of rigid bodies and others";
  if (v.allFinite()) require_convergence(report, system, parameters_.solvers.tolerance);
}

/// Sets the shape in the layers of the velocity system, and assembles their rows if the options ask for it.
void Capsule::assemble_layers(const Net& x) {
  const auto n = static_cast<double>(x.rows());
  constexpr double most_bytes = 1e9;
  const auto assemble = [&](stokes::Layer& layer, bool by_clusters, stokes::Rows<double>& rows) {
    if (!repeats() && parameters_.solvers.assembled(by_clusters)) layer.assemble(own_targets(), rows);
    else rows.resize(0, 0);
  };
  // Thin films between rigid bodies take many iterations, for which it is faster to assemble the matrix (72 n^2 bytes).
  const bool many_iterations = !rigid_.empty() && 72 * n * n < most_bytes;
  if (double_layer_) double_layer_->place(x), assemble(*double_layer_, double_layer_->by_clusters() && !many_iterations, double_rows_);
  if (viscous_) layer_.place(x, measure()), assemble(layer_, layer_.by_clusters(), single_rows_);
}

/// Returns D v - (1/mu) A f at the targets (D: double layer, A: single layer), by assembled rows if there are any. An empty f is treated as zero.
Net Capsule::layers_of(const Net& x, const Net& v, const Net& f) {
  const auto times = [&](const stokes::Rows<double>& all, const Net& field) {  // product of the assembled rows of all ranks with a field
    Net at_targets = zero_at_targets();
    const Eigen::VectorXd rows = all * Eigen::Map<const Eigen::VectorXd>(field.data(), field.size());
    for (Eigen::Index k = 0; const int i : own_targets()) at_targets.row(i) = rows.segment<3>(3 * k++).transpose();
    gather_targets(false, at_targets);
    return at_targets;
  };
  Net u = !double_layer_ ? zero_at_targets() : double_rows_.cols() > 0 ? times(double_rows_, v) : double_layer_of(v);
  if (f.size() > 0) u -= (single_rows_.cols() > 0 ? times(single_rows_, f) : single_layer_of(x, f)) / parameters_.viscosity;
  return u;
}

/// Solves P B P v = rhs (4.2) for v, where rhs = P rhs. P is the projection (2.8) that removes changes of the volumes, given by the vectors b and c;
/// if b and c are empty, the volumes are free and P = 1. In a tube, B either includes the response of the wall to v (option `schur`), or
/// solve_blocks() solves for v and the wall tractions together. The initial guess is `guess`; if it is empty or there are rigid bodies, it is rhs.
Net Capsule::solve_velocity(const Net& x, const Net& f, const Net& b, const Net& c, const Net& rhs, const Net& guess) {
  const auto clock = phases_.time("velocity system");
  const Eigen::Index n = x.rows();
  assemble_layers(x);
  const auto load_of = [&](const Net& v) {  // returns the velocity-dependent load (viscous membranes, prescribed rigid motions); empty if there is
                                            // none
    Net load = rigid_.prescribed() ? rigid_.completing_load(v) : Net();
    if (viscous_) load = load.size() > 0 ? Net(load + viscous_load(x, v)) : viscous_load(x, v);
    return load;
  };
  const auto without_wall = [&](const Net& v, const Net& load) -> Net {  // B v
    if (!double_layer_ && !viscous_) return v;
    Net bv = v - serial_control_values(layers_of(x, v, load));
    rigid_.complete(v, bv);
    return bv;
  };
  if (!schur()) return solve_blocks(load_of, without_wall, f, b, c, rhs);
  const auto project = [&](Net& v) {
    if (b.size() > 0) constrain(v, b, c);
  };
  const auto apply = [&](const double* in, double* out) {
    Net v = Eigen::Map<const Net>(in, n, 3);
    project(v);
    const Net load = load_of(v);
    Net bv = without_wall(v, load);
    if (tube_ || solids()) bv -= velocity_by_walls(x, load, v);
    project(bv);
    Eigen::Map<Net>(out, n, 3) = bv;
  };
  const Eigen::VectorXd right = Eigen::Map<const Eigen::VectorXd>(rhs.data(), rhs.size());
  Eigen::VectorXd v = guess.size() > 0 && rigid_.empty() ? Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(guess.data(), guess.size())) : right;
  if (!alone_) alone_.emplace(particles(), rigid_, rest_, parameters_.quadrature);
  const auto rows_of = [&](std::span<const int> targets) { return double_rows_of(x, targets); };
  const FilmInverses films(particles(), *alone_, rigid_, x, rows_of);
  const auto precondition = [&](const double* in, double* out) {
    Net y = Eigen::Map<const Net>(in, n, 3);
    alone_->take_to_sites(y);
    films.add(y);
    alone_->solve(rigid_, y);
    Eigen::Map<Net>(out, n, 3) = y;
  };
  const LinearSystem system{velocity_blocks(), apply, alone_->empty() ? Apply() : precondition};
  note(velocity_solver_.solve(system, right, v, parameters_.solvers.tolerance), v);
  Net solution = Eigen::Map<const Net>(v.data(), n, 3);
  project(solution);
  return solution;
}

/// Solves for the velocity v, the wall traction f^D, the pressure drop dp (2.5)-(2.7) and the volume multipliers (2.8) in one system. The right-hand
/// side rhs = v_inf - (1/mu) R^-1 A f is also the initial guess of v. `load` and `unbounded`: see BlockSystem.
Net Capsule::solve_blocks(const std::function<Net(const Net&)>& load, const std::function<Net(const Net&, const Net&)>& unbounded,
                          const Net& f, const Net& b, const Net& c, const Net& rhs) {
  const auto control_values = [&](const Net& at_sites) { return collocation_.solve(at_sites); };
  std::vector<spline::Block> constrained;
  for (const Particle& one : particles())
    if (b.size() > 0 && !one.rigid) constrained.push_back(one.block);
  const BlockSystem system{*tube_, load, unbounded, control_values, b, c, constrained, tube_->wall().radius() / parameters_.viscosity};
  const Eigen::VectorXd right = system.right_hand_side(rhs, f);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size());
  x.head(rhs.size()) = right.head(rhs.size());
  note(velocity_solver_.solve(system.linear_system(velocity_blocks(), parameters_.solvers.tube), right, x, parameters_.solvers.tolerance), x);
  return Eigen::Map<const Net>(x.data(), rhs.rows(), 3);
}

Blocks Capsule::velocity_blocks() const {
  if (particles().size() == 1) return {{"velocity", 3 * space_.n_points}};
  Blocks blocks;
  for (const Particle& particle : particles())
    blocks.push_back({formatted("velocity of particle %d", static_cast<int>(blocks.size()) + 1), 3 * particle.block.n_points});
  return blocks;
}

/// Solves for the tractions on rigid bodies (2.40) and the velocity v of deformable particles (2.52). Returns the velocity of all particles. `flow`:
/// part of the velocity that does not depend on these unknowns. Adds the loads that depend on the unknowns to e.load_.
Net Capsule::solve_tractions(Evaluation& e, const Net& x, const Net& b, const Net& c, const Net& flow) {
  const auto clock = phases_.time("tractions");
  assemble_layers(x);
  const auto parts = [this, x, b, c](const Net& y) {  // returns the velocity of deformable particles, and the load that depends on the unknowns y
    std::pair<Net, Net> both{y, Net::Zero(y.rows(), 3)};
    auto& [v, load] = both;
    rigid_.clear(v);
    if (b.size() > 0) constrain(v, b, c);
    if (viscous_) load = viscous_load(x, v);
    for (const Particle& one : particles())
      if (one.rigid) one.block.rows(load) = -one.block.rows(y);
    return both;
  };
  const auto product = [this, x, b, c, parts](const Net& y, const Net& caused) {
    const auto [v, load] = parts(y);
    Net other = viscous_ || caused.size() == 0 ? load : Net();  // load that does not contribute to the velocity `caused`
    if (viscous_ && caused.size() > 0) rigid_.clear(other);
    if (double_layer_) double_layer_->place(x);
    Net u = layers_of(x, v, other);
    if (caused.size() > 0) u += caused;
    if (tube_) u += tube_->respond(load, v).velocity;
    if (solids()) add_solids(x, load, v, false, u);
    if (tractions_->alone()) return u;
    Net all = v - serial_control_values(u);
    if (b.size() > 0) constrain(all, b, c);
    for (const Particle& one : particles())
      if (one.rigid) one.block.rows(all) = one.block.rows(u);
    return all;
  };
  const Net known = e.load_;
  const auto load = [known, parts](const Net& y) { return Net(known + parts(y).second); };
  std::vector<Vec3> centres;
  std::vector<Rigid> driven;
  for (std::size_t p = 0; p < particles().size(); ++p)
    if (rigid_.holds(p)) centres.push_back(rigid_.centre(p)), driven.push_back(rigid_.given(p));
  const bool responds = repeats() || tube_ || solids() || double_layer_ || viscous_;
  tractions_->solve(x, centres, driven, flow_, RigidTractions::Surroundings{flow, responds, product, load});
  Net v = parts(tractions_->unknowns()).first;
  auto body = tractions_->bodies().begin();
  for (std::size_t p = 0; p < particles().size(); ++p)
    if (rigid_.holds(p)) rigid_.move(p, body->motion, body->force, body->torque, v), ++body;
  e.load_ = load(tractions_->unknowns());
  for (const SolveReport& report : tractions_->reports()) note(report, Eigen::Map<const Eigen::VectorXd>(v.data(), v.size()));
  if (tube_) e.response_ = tube_->respond(e.load_, v, tractions_->lacking_pressure());
  return v;
}

/// Returns the first moment int df r dG of the load df on particle p, a rigid body whose unknown is its traction, at the shape of `at`.
Mat3 Capsule::moment_by_traction(Evaluation& at, std::size_t p) {
  at.rigid();
  const Mat3 moment = tractions_->moment(static_cast<std::size_t>(std::ranges::count_if(
      std::span(particles()).first(p), [](const Particle& one) { return one.rigid.has_value(); })));
  for (const SolveReport& report : tractions_->reports()) note(report, Eigen::Map<const Eigen::VectorXd>(at.x().data(), at.x().size()));
  return -moment;
}

}  // namespace tanktread::coupling
