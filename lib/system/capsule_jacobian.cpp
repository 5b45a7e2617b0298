#include "system/capsule_jacobian.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "system/equations/volumes.hpp"

namespace tanktread::coupling {

namespace {

/// Returns whether the particle's membrane nearly conserves its area: its area modulus exceeds its shear modulus by more than the factor `times`.
bool resists_area(const Particle& one) {
  constexpr double times = 50;
  return !one.rigid && membrane::area_modulus(one.material.law) > times * membrane::modulus(one.material.law);
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

/// The collocation sites with frozen layers. The ambient velocity there is its change due to the displacement.
class FrozenAtSites : public LayersAt {
 public:
  /// `ambient`: change of the ambient velocity at the sites or, if not `at_sites`, its control values.
  FrozenAtSites(FrozenLayers& layers, double viscosity, Net ambient, bool at_sites)
      : layers_(layers), viscosity_(viscosity), ambient_(std::move(ambient)), at_sites_(at_sites) {}

  Net ambient() override { return ambient_; }
  Net ambient_control_values() override { return at_sites_ ? Net() : ambient_; }
  Net of_particles(const Net& load, const Net& density) override {
    Net u = density.size() > 0 ? layers_.double_layer(density) : Net(Net::Zero(layers_.n_points(), 3));
    if (load.size() > 0) u -= layers_.single_layer(load) / viscosity_;
    return u;
  }
  void add_walls(const FluidWalls::Response& walls, Net& u) override { u += walls.tube.velocity; }

 private:
  FrozenLayers& layers_;
  double viscosity_;
  Net ambient_;
  bool at_sites_;
};

/// Velocities of deformable particles in the Jacobian. Given is the work of a displacement; the rows of rigid bodies are the identity.
class FrozenVelocities : public Equation {
 public:
  /// `moves`: whether velocities are sources, by the double layer or by viscous loads.
  FrozenVelocities(std::span<const Particle> particles, const Membranes& membranes, Net work, bool has_double, bool moves)
      : particles_(particles), membranes_(membranes), work_(std::move(work)), has_double_(has_double), moves_(moves) {}

  void add_sources(const BlockVector& x, Given given, Sources& to) const override {
    if (given == Given::included && work_.size() > 0) to.add_work(work_);
    Net moving = System::particles(x);
    if (!moves_ || moving.isZero(0)) return;
    clear_rigid(particles_, moving);
    if (membranes_.viscous()) to.add_work(membranes_.viscous_work_change(moving));
    if (has_double_) to.add_density(std::move(moving));
  }
  void add_loads_of_work(Sources& to) const override {
    Net work = to.work;
    clear_rigid(particles_, work);
    to.add_load(membranes_.solved(std::move(work)));
  }
  void add_velocity(const BlockVector& x, Given, Net& v) const override { v += System::particles(x); }
  void add_residual(const BlockVector& x, const Sources&, const SurfaceVelocity& u, Given, BlockVector& r) const override {
    Net caused = u.control_values();
    clear_rigid(particles_, caused);
    System::particles(r) += System::particles(x) - caused;
  }

 private:
  std::span<const Particle> particles_;
  const Membranes& membranes_;
  Net work_;
  bool has_double_, moves_;
};

/// An equation that the program adds, without its terms that do not depend on the unknowns.
class FrozenEquation : public Equation {
 public:
  explicit FrozenEquation(std::shared_ptr<const Equation> exact) : exact_(std::move(exact)) {}
  void add_sources(const BlockVector& x, Given, Sources& to) const override { exact_->add_sources(x, Given::omitted, to); }
  void add_residual(const BlockVector& x, const Sources& from, const SurfaceVelocity& u, Given, BlockVector& r) const override {
    exact_->add_residual(x, from, u, Given::omitted, r);
  }

 private:
  std::shared_ptr<const Equation> exact_;
};

class FrozenTube : public Equation {
 public:
  explicit FrozenTube(Tube& tube) : tube_(tube) {}
  void answer(const BlockVector&, Given, Sources& to) const override {
    to.walls.emplace().tube.velocity = tube_.frozen_response(to.load, to.density);
  }

 private:
  Tube& tube_;
};

}  // namespace

CapsuleJacobian::CapsuleJacobian(VelocitySolver& solver, FrozenLayers& frozen)
    : parameters_(solver.parameters()), flow_(solver.flow()),
      flow_at_sites_(flow_at_targets(solver.walls(), solver.flow())), targets_(solver.targets()),
      membranes_(solver.membranes()), volumes_(solver.volumes()), frozen_(frozen), explicit_(solver.is_explicit()), tube_(solver.walls().tube),
      interface_(solver.interface()), counts_(solver.counts()), added_{solver.equations(), {}, {}},
      unknowns_(std::make_shared<const Layout>(with_added(blocks_of_particles(parameters_.particles)))),
      solvers_{Krylov(parameters_.solvers.of(parameters_.solvers.implicit_step)), Krylov(parameters_.solvers.of(parameters_.solvers.velocity))} {
  if (std::ranges::none_of(parameters_.particles, [](const Particle& one) { return one.material.area_order > 0; })) return;
  const Eigen::VectorXd areas = membranes_.mass_matrix().row_sums(membranes_.unstressed());
  area_.emplace(membranes_.membrane(), mobilities(parameters_.particles, areas, parameters_.viscosity));
  if (area_->empty()) area_.reset();
}

void CapsuleJacobian::linearise(const Net& x, const Net& energy_gradient, const std::vector<Net>& sums, const Slip& slip,
                                const BlockVector& solution) {
  x_ = x, added_.solution = solution;
  added_.here.clear();
  if (!interface_) std::ranges::move(added_.all.at(x, *unknowns_), std::back_inserter(added_.here));
  membranes_.linearise(x, sums);
  frozen_.turn_to(x);
  if (area_) area_->set_shape(x);
  if (flow_at_sites_) gradients_ = gradients_at(targets_.at_sites() * x);
  if (!interface_ && !parameters_.volume.constrained()) return;
  const Net gradient = volumes_.gradient(x);
  if (parameters_.volume.constrained()) projection_ = volumes_.projection(gradient, membranes_.solved(gradient));
  if (!interface_) return;
  interface_->linearise(x, gradient, slip);
  pressures_.clear();
  for (const Particle& one : parameters_.particles) {
    const Net y = one.block.rows(x).rowwise() - one.block.rows(x).colwise().mean();
    if (one.slides()) pressures_.push_back({one.block, dot(Net(one.block.rows(energy_gradient)), y) / dot(Net(one.block.rows(gradient)), y)});
  }
}

/// Returns the velocity gradients of the flow at x. If the scene is symmetric, computes only one gradient per symmetry orbit, at the fundamental
/// point. The gradients at other points are then zero.
std::vector<Mat3> CapsuleJacobian::gradients_at(const Net& x) const {
  const std::vector<int>& rows = parameters_.symmetry.fundamental();
  if (static_cast<Eigen::Index>(rows.size()) == x.rows()) return flow_.gradients(x);
  const std::vector<Mat3> found = flow_.gradients(x(rows, Eigen::all));
  std::vector<Mat3> all(static_cast<std::size_t>(x.rows()), Mat3::Zero());
  for (std::size_t k = 0; k < rows.size(); ++k) all[static_cast<std::size_t>(rows[k])] = found[k];
  return all;
}

Net CapsuleJacobian::inflation(const Net& c) {
  constexpr double rough = 0.1;  // relative residual
  if (latest_shift_ == 0 || interface_ || c.rows() != projection_.gradient.rows()) return c;
  if (std::ranges::none_of(parameters_.particles, resists_area)) return c;
  const double shift = latest_shift_;
  const Apply apply = on_nets(c.rows(), [&](const Net& delta) { return step_change(delta, {}, shift, {}).rate; });
  const Apply precondition = area_ ? on_nets(c.rows(), [this](const Net& r) { return area_->apply(r); }) : Apply();
  const Net along = parameters_.symmetry.completed(as_net(solve_step(shift, apply, precondition, flat(c), rough)));
  return along.allFinite() ? along : c;
}

/// Returns `work` (0 if it has no rows) minus the change of the work of a pressure p on each particle whose control points slide, so that product()
/// adds to it
///
///   (H - p d2V/dx2) dx,   p = (dE/dx).y/(dV/dx.y),   y = x minus its mean                                                          (4.35)
///
/// `db`: d2V/dx2 dx. A pressure causes no flow, A n = 0, at any shape. If points slide, the normals n at these points change. The operator A is
/// frozen at an earlier shape, and would compute a velocity proportional to p from this change. With this velocity, a drop with Ca = 1e-4 in a tube
/// takes nine times as many steps.
Net CapsuleJacobian::without_pressure(Net work, const Net& db) const {
  if (work.size() == 0) work = Net::Zero(db.rows(), 3);
  for (const auto& [block, p] : pressures_) block.rows(work) -= p * block.rows(db);
  return work;
}

/// Returns P B P v + (1 - P) v - shift B J dx, with the operator B of (4.2) and
///
///   B J dx = P (grad v_inf dx - (1/mu) R^{-1} A M0^{-1} H dx)                                                                      (4.3)
///
/// P is the volume projection (2.8), v_inf the ambient velocity, R the collocation matrix, A the frozen single layer, M0 the mass matrix, and H the
/// membrane tangent. `added_work`, if given, is added to H dx. v or dx may have no rows, which stands for 0. In the rows of rigid bodies, B is the
/// identity and B J dx is 0. This is the residual of the system with frozen layers and walls, in which the displacement is what is given. It has the
/// rows of the added equations, whose unknowns are `added` if they are not zero.
BlockVector CapsuleJacobian::product(const Net& v, const Eigen::VectorXd& added, const Net& dx, double shift, const Net& added_work) {
  const bool displaced = dx.size() > 0;
  BlockVector x(unknowns_);
  if (v.size() > 0) System::particles(x) = v;
  x.numbers().tail(added.size()) = added;
  if (explicit_ && !displaced && added_.here.empty()) return x;
  Net work, moved;
  if (displaced) {
    work = shift * membranes_.work_change(dx);
    if (added_work.size() > 0) work += shift * added_work;
    if (!added_.here.empty()) {
      Net change = Net::Zero(dx.rows(), 3);
      added_.all.add_work_change(x_, added_.solution, dx, change);
      work += shift * change;
    }
    moved = flow_at_sites_ ? Net(shift * (targets_.at_sites() * dx)) : Net(shift * dx * flow_.gradient(Vec3::Zero()).transpose());
    for (Eigen::Index i = 0; flow_at_sites_ && i < moved.rows(); ++i)
      moved.row(i) = (moved.row(i) * gradients_[static_cast<size_t>(i)].transpose()).eval();
  }
  System::Equations equations;
  equations.push_back(std::make_unique<FrozenVelocities>(parameters_.particles, membranes_, std::move(work), frozen_.has_double(), !explicit_));
  if (projection_.active()) equations.push_back(std::make_unique<VolumeConstraint>(projection_, nullptr));
  if (tube_) equations.push_back(std::make_unique<FrozenTube>(*tube_));
  const auto layers = std::make_shared<FrozenAtSites>(frozen_, parameters_.viscosity, std::move(moved), flow_at_sites_);
  for (const auto& one : added_.here) equations.push_back(std::make_unique<FrozenEquation>(one));
  const System system(unknowns_, std::move(equations), layers, [this](const Net& u) { return targets_.collocated(u); });
  BlockVector r = system.residual(x, displaced ? Given::included : Given::omitted);
  constexpr double regular = 1e-8;  // equations that act on rigid bodies only, whose rows of J are 0, have no other entries in these columns
  r.numbers().tail(n_added()) += regular * x.numbers().tail(n_added());
  return r;
}

/// Returns the rows of the particles, and those of the added equations times a weight. Without it, an iterative solver would neglect their few rows.
CapsuleJacobian::RateChange CapsuleJacobian::parted(const BlockVector& r, double weight) const {
  return {System::particles(r), {}, weight * r.numbers().tail(n_added())};
}

CapsuleJacobian::RateChange CapsuleJacobian::step_preconditioner(const Net& r, const Eigen::VectorXd& added) const {
  BlockVector rows(unknowns_), x(unknowns_);
  System::particles(rows) = r, rows.numbers().tail(added.size()) = added / row_weight();
  x = rows;
  System::particles(x) = area_ ? area_->apply(r) : r;
  for (const auto& one : added_.here) one->precondition(rows, x);
  return parted(x, 1);
}

/// Solves B v = rhs for v to the relative residual `tolerance`.
Net CapsuleJacobian::fluid_velocity(const Net& rhs, double tolerance) {
  const LinearSystem system{blocks_of_particles(parameters_.particles),
                            on_nets(rhs.rows(), [this](const Net& u) { return Net(System::particles(product(u, {}, {}, 0, {}))); }), {}};
  Eigen::VectorXd v = flat(rhs);
  counts_.solver_iterations += solvers_.inner.solve(system, flat(rhs), v, tolerance).iterations;
  return as_net(v);
}

/// Returns the change J dx of the fluid velocity due to the displacement dx. Solves B (J dx) = rhs to a smaller tolerance than the system of
/// an implicit step, because each product with the matrix of that system may require this solve.
Net CapsuleJacobian::fluid_velocity_change(const Net& dx, const Net& added_work) {
  const Net rhs = System::particles(product({}, {}, dx, -1, added_work));
  return explicit_ ? rhs : fluid_velocity(rhs, 1e-3);
}

CapsuleJacobian::RateChange CapsuleJacobian::velocity_change(const Net& dx, const Net& added_work) {
  if (!interface_) return {fluid_velocity_change(dx, added_work), {}};
  const Net db = (volumes_.gradient(x_ + dx) - volumes_.gradient(x_ - dx)) / 2;  // d2V/dx2 dx, exact because V is a cubic form
  const Net dv = fluid_velocity_change(dx, without_pressure(added_work, db));
  const Net du = interface_->derivative(dv, dx, db);
  return {du, dv - du};
}

CapsuleJacobian::RateChange CapsuleJacobian::step_change(const Net& dx, const Eigen::VectorXd& added, double shift, const Net& added_work) {
  if (!interface_) return parted(product(dx, added, dx, shift, added_work), row_weight());
  RateChange change = velocity_change(dx, added_work);
  return {dx - shift * change.rate, std::move(change.slip)};
}

/// Returns the factor of the relative residual at high viscosity ratios. B weighs deformation by about lambda/2 but rigid rotation by 1, so that a
/// residual of a few percent would be larger than the rotation of a hardly deforming particle. The iteration of a step then converges slowly or not
/// at all: with lambda = 100, a capsule in shear took 144 steps instead of 12. Above lambda = 2e4, a smaller residual does not help, because the
/// stored operator (FrozenOperator) is rounded to 2^-9.
double CapsuleJacobian::tolerance_factor() const {
  constexpr double least = 10, most = 2e4;
  double ratio = 1;
  for (const Particle& particle : parameters_.particles)
    if (!particle.rigid && !interface_) ratio = std::max(ratio, particle.viscosity_ratio);
  return ratio > least && ratio <= most ? least / ratio : 1;
}

Eigen::VectorXd CapsuleJacobian::solve_step(double shift, const Apply& product, const Apply& precondition, const Eigen::VectorXd& rhs,
                                            double tolerance) {
  latest_shift_ = shift;
  if (area_) area_->factor(shift);
  Eigen::VectorXd solution = Eigen::VectorXd::Zero(rhs.size());
  const LinearSystem system{one_block("displacement", rhs.size()), product, precondition};
  const SolveReport report = solvers_.step.solve(system, rhs, solution, tolerance * tolerance_factor());
  ++counts_.solves;
  counts_.solver_iterations += report.iterations;
  return solution;
}

void CapsuleJacobian::improve_start(Net& y, const Net& before, double shift) {
  if (!area_) return;
  area_->restore_areas(y, before, shift);
  y = parameters_.symmetry.completed(std::move(y));
}

}  // namespace tanktread::coupling
