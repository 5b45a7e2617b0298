#include "system/capsule.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/formatted.hpp"
#include "base/small_matrices.hpp"
#include "system/collocation.hpp"
#include "system/solids/rigid_tractions.hpp"
#include "system/symmetry.hpp"

namespace tanktread::coupling {

namespace {

bool same(const Net& a, const Net& b) { return a.rows() == b.rows() && a == b; }

}  // namespace

/// Sets the time. Cached results are kept unless the flow or the cell changes.
void Capsule::at(double time, double start) {
  const bool other_flow = flow_.at(time, start), other_cell = parameters_.cell && deform_cell(time);
  if (other_flow || other_cell) latest_.reset();
}

void Capsule::replicate(Net& net) { ranks_.replicate(net); }

/// Sums the contributions of all elements over all ranks. If only one element of each symmetry orbit contributes, first adds the sums at image points
/// to the fundamental points.
void Capsule::replicate_sums(Net& net) {
  if (folded_) surface::fold(parameters_.symmetry, net);
  replicate(net);
}

/// Gathers the result of an operator on all ranks. If the ranks shared the far sums (`shared`), adds up the results of all ranks. Otherwise copies
/// each row from the rank that owns it.
void Capsule::gather(bool shared, Net& net) {
  if (!shared) return replicate(net);
  Net* const one[] = {&net};
  ranks_.add(one);
}

/// Gathers the velocity at the points where velocities are evaluated (the targets) on all ranks. `shared`: see gather().
void Capsule::gather_targets(bool shared, Net& net) {
  if (!projection_) return gather(shared, net);
  ranks_.add({net.data(), static_cast<std::size_t>(net.size())});
}

/// Returns dE/dx of all loads minus the virtual work of the forces set by set_forces(), one row per control point; 0 for rigid bodies. Sets `sums` to
/// the surface integrals of the loads, summed over all ranks.
Net Capsule::work_of_loads(const Net& x, std::vector<Net>& sums) {
  Net work(x.rows(), 3);
  membrane_.load(x, own_elements_, work);
  sums = complete_work(x, work);
  for (const Net& of_forces : forces_)
    if (of_forces.size() > 0) work -= of_forces;
  rigid_.clear(work);  // rows of rigid bodies are 0; push_bodies() applies the forces on rigid bodies instead
  return work;
}

/// Adds to `work` the terms of dE/dx that all loads except elasticity and bending contribute at the shape x. `work` has one row per control point. On
/// entry it contains the contributions of the elements of this rank. On return it contains the sum over all ranks. Returns the nets that the loads
/// need in their global phase (membrane::Load), also summed over all ranks.
std::vector<Net> Capsule::complete_work(const Net& x, Net& work) {
  std::vector<Net> sums = loads_.add_work(x, work);
  replicate_sums(work);
  for (Net& sum : sums) replicate_sums(sum);
  loads_.add_global_work(x, sums, work);
  return sums;
}

void Capsule::set_forces(Forces of, Net work) {
  Net& known = forces_[static_cast<std::size_t>(of)];
  if (same(work, known)) return;
  known = std::move(work);
  latest_.reset();
}

Net Capsule::response(Evaluation& at, const Net& work) {
  Net& contacts = forces_[static_cast<std::size_t>(Forces::contacts)];
  const Net base = at.velocity(), before = contacts;
  set_forces(Forces::contacts, before.size() > 0 ? Net(before + work) : work);
  const Net change = velocity(at.x()) - base;
  set_forces(Forces::contacts, before);
  return change;
}

/// Sets the forces of contacts and loads on rigid bodies, in addition to their prescribed forces.
void Capsule::push_bodies(const Net& x) {
  if (rigid_.empty()) return;
  Net push = forces_[static_cast<std::size_t>(Forces::contacts)];
  if (std::ranges::any_of(particles(), [](const Particle& one) { return one.rigid && !one.loads.empty(); })) {
    Net work = Net::Zero(x.rows(), 3);
    complete_work(x, work);
    push = push.size() > 0 ? Net(push - work) : Net(-work);
  }
  rigid_.push(push);
}

/// Applies the inverse of the factored matrix a to each field in place. The columns of the fields are divided among the ranks.
void Capsule::solve(const membrane::SymmetricSolver& a, std::span<Net* const> fields) {
  const std::vector<int> components = a.components();
  int column = 0;
  for (Net* const field : fields) {
    std::vector<int> mine;
    for (const int c : components)
      if (ranks_.owner(column++, 3 * static_cast<int>(fields.size())) == ranks_.rank()) mine.push_back(c);
    *field = a.solve(*field, mine);
  }
  ranks_.add(fields);
}

Net Capsule::solved(const membrane::SymmetricSolver& a, Net field) {
  Net* const one[] = {&field};
  solve(a, one);
  return field;
}

/// Returns the load of the membranes at x, which is the shape of `e` or, on a lattice, this shape with particles moved into the cell. If `other` is
/// given, replaces it by M0^-1 times `other` (M0: mass matrix). Where possible, the two systems with M0 are solved in one call, because six columns
/// of right-hand sides are divided among the ranks more evenly than three.
Net Capsule::membrane_load(Evaluation& e, const Net& x, Net* other) {
  const auto clock = phases_.time("membrane");
  const bool together = other && measure() == stokes::Measure::reference;
  if (other && !together) *other = solved(mass_.reference(), std::move(*other));
  if (parameters_.strong_load) {
    Net t = Net::Zero(x.rows(), 3);
    membrane_.strong_load(x, own_points_, t);
    replicate(t);
    return solved(collocation_, std::move(t));
  }
  if (e.work_.size() == 0) e.work_ = work_of_loads(x, e.load_sums_);
  Net d = e.work_;
  if (!together) return measured_load(x, std::move(d));
  const auto projection = phases_.time("projection");
  Net* const both[] = {&d, other};
  solve(mass_.reference(), both);
  return d;
}

Net Capsule::flux_vector(const Net& x) {
  const auto clock = phases_.time("volume");
  Net b(x.rows(), 3);
  geometry_.volume_gradient(x, own_elements_, b);
  replicate_sums(b);
  return b;
}

/// Applies the projection P of (2.8) to v for each deformable particle, so that its volume does not change.
void Capsule::constrain(Net& v, const Net& b, const Net& c) const {
  for (const Particle& particle : particles()) {
    if (particle.rigid) continue;
    const auto rows = [&](const Net& net) { return particle.block.rows(net).array(); };
    particle.block.rows(v) -= (rows(b) * rows(v)).sum() / (rows(b) * rows(c)).sum() * particle.block.rows(c);
  }
}

/// Returns velocity fields that rotate the meshes of drops on their surfaces, and have the symmetry of the scene. The shape does not change.
std::vector<Net> Capsule::relabellings(const Net& x) {
  std::vector<int> axes;
  for (int k = 0; k < 3; ++k) {
    const auto keeps = [k](const surface::Image& g) { return g.signs.prod() * g.signs[k] > 0; };
    if (std::ranges::all_of(parameters_.symmetry.images(), keeps)) axes.push_back(k);
  }
  std::vector<Net> all;
  if (interface_) all = interface_->rotations(x, axes);
  for (const Particle& one : particles()) {
    if (one.rigid || one.slides() || std::ranges::any_of(one.loads, &membrane::Load::depends_on_labels)) continue;
    for (const int k : axes)
      if (const auto field = label_rotation(space_, one.block, unstressed_, x, k, collocation_)) all.push_back(*field);
  }
  return all;
}

Net Capsule::symmetric(Net field) const {
  parameters_.symmetry.complete(field);
  return field;
}

std::shared_ptr<Evaluation> Capsule::evaluate(const Net& x, const Net& guess) {
  if (latest_ && same(x, latest_->x())) return latest_;
  ++work_.evaluations;
  latest_.reset();
  const auto e = std::make_shared<Evaluation>(*this, x);
  e->velocity_ = symmetric(in_cell(*e, guess));
  e->solved_ = true;
  if (!rigid_.empty()) e->rigid_ = rigid_;
  if (e->velocity_.allFinite()) latest_ = e;
  return e;
}

std::shared_ptr<Evaluation> Capsule::evaluation(const Net& x, const Net& velocity, double distance) {
  if (!latest_ || !same(x, latest_->x())) return std::make_shared<Evaluation>(*this, x, velocity, evaluated_about(x, distance) ? latest_ : nullptr);
  if (velocity.size() > 0) latest_->known_ = velocity;
  return latest_;
}

/// Computes (4.2) step by step: the load (membrane_load and rigid bodies), its velocity and the ambient flow (explicit_velocity), the projection onto
/// constant volumes (constrain), and the solution of the system for the velocity (solve_velocity), if there is one (has_velocity_system).
Net Capsule::solve(Evaluation& e, Net x, const Net& guess) {
  rigid_.place(x);
  if (!x.allFinite() || (tube_ && !enter_tube(x)) || !in_front_of_wall(x))
    return Net::Constant(x.rows(), 3, std::numeric_limits<double>::quiet_NaN());
  push_bodies(x);
  const bool deforms = !tractions_ || !tractions_->alone(), constrained = deforms && parameters_.volume.constraint != "none";
  const Net b = constrained ? flux_vector(x) : Net();
  Net c = b;
  Net f = deforms ? membrane_load(e, x, constrained ? &c : nullptr) : Net::Zero(x.rows(), 3);
  if (!tractions_) rigid_.add_load(f);
  e.load_ = f;
  Net v = explicit_velocity(x, f, {}, &e.response_);
  if (!tractions_) rigid_.add_lacking(v), rigid_.subtract_prescribed(v);
  if (constrained) constrain(v, b, c);
  if (viscous_) viscous_->update(x, own_elements_);
  if (tractions_) v = solve_tractions(e, x, b, c, symmetric(v));
  else if (has_velocity_system()) v = solve_velocity(x, f, b, c, v, interface_ ? Net() : guess);
  e.unknowns_ = v;
  if (viscous_ && !tractions_) e.load_ += viscous_load(x, symmetric(v));
  if (!rigid_.empty() && !tractions_) {
    e.unknowns_ = symmetric(v);
    e.load_ += rigid_.completing_load(v);
    rigid_.move(v);
  }
  if (!interface_) return v;
  e.fluid_ = symmetric(v);
  const auto clock = phases_.time("interface motion");
  v = interface_->velocity(x, constrained ? b : flux_vector(x), v);
  if (constrained) constrain(v, b, c);  // removes the small change of volume that the spline interpolation of the normal velocity causes
  return v;
}

/// Returns the control values of a velocity that is given at the targets.
Net Capsule::control_values(Net at_targets) {
  return projection_ ? projection_->control_values(at_targets) : solved(collocation_, std::move(at_targets));
}

/// Returns A f, the single layer of the load f, at the targets. Skips the sum if f is zero.
Net Capsule::single_layer_of(const Net& x, const Net& f) {
  Net u = zero_at_targets();
  if (f.isZero(0)) return u;
  {
    const auto clock = phases_.time("single layer");
    layer_.place(x, measure());
    layer_.apply(f, own_targets(), u);
  }
  gather_targets(layer_.shared(), u);
  return u;
}

/// Returns the double layer of v at the targets, including the factors 1 - lambda, for the shape set in `double_layer_`.
Net Capsule::double_layer_of(const Net& v) {
  Net hv = zero_at_targets();
  double_layer_->apply(v, own_targets(), hv);
  gather_targets(double_layer_->shared(), hv);
  return hv;
}

/// Returns v_inf - (1/mu) R^-1 A f of (4.2), with R the collocation matrix and A the single layer. In a tube with eliminated wall unknowns, adds the
/// response of the wall to the load f and, if given, to the velocity `moves` of the particle. Stores this response in `answer`, if given. Exception:
/// if a linear system for the velocity follows, stores nothing, because its solution changes the response.
Net Capsule::explicit_velocity(const Net& x, const Net& f, const Net& moves, std::optional<Tube::Response>* answer) {
  Net u = single_layer_of(x, f);
  if (by_sites()) {
    const bool known = tube_ && flow_.duct();
    const Eigen::SparseMatrix<double>& values = projection_ ? projection_->values() : sites_;
    u = (known ? flow_.amplitude() * tube_->ambient() : flow_.velocities(values * x)) - u / parameters_.viscosity;
    if (solids()) add_solids(x, f, moves, true, u);
    if (tube_ && schur()) {
      Tube::Response response = tube_->respond(f, moves);
      u += response.velocity;
      if (answer && !has_velocity_system()) *answer = std::move(response);
    }
    const auto clock = phases_.time("projection");
    return control_values(std::move(u));
  }
  Net v = flow_.velocities(x);  // control values of an affine flow, which are exact because the basis functions sum to one
  const auto clock = phases_.time("projection");
  v -= control_values(std::move(u)) / parameters_.viscosity;
  return v;
}

/// Sets the shape in the tube. Returns whether all its collocation sites are inside.
bool Capsule::enter_tube(const Net& x) {
  place(x);
  const Net at_sites = sites_ * x;
  if (tube_->fixed()) return !ranks_.any(!tube_->inside(at_sites, own_points_));
  const surface::Outline& outline = tube_->wall().outline;
  const bool outside = std::ranges::any_of(own_points_, [&](int i) {
    const surface::Vec2 place(at_sites(i, 1), at_sites(i, 2));
    return (place - outline.centroid()).norm() >= inner_radius_ && !outline.inside(place);
  });
  return !ranks_.any(outside);
}

/// Returns true if all collocation sites are in front of the plane walls, or if there are none.
bool Capsule::in_front_of_wall(const Net& x) {
  if (solids()) return solids()->inside(sites_ * x);
  return !parameters_.wall || stokes::in_front({&*parameters_.wall, 1}, sites_ * x);
}

/// Returns the load whose virtual work on the surface x is d (one row per control point): per unstressed area (3.7), or per current area (3.6).
Net Capsule::measured_load(const Net& x, Net d) {
  const auto clock = phases_.time("projection");
  return measure() == stokes::Measure::reference ? solved(mass_.reference(), std::move(d)) : mass_.solve(mass_matrix_.update(measured_net(x)), d);
}

/// Returns C v, the virtual work of the membranes' viscous stress (3.10) at the velocity v, with the matrix C for the shape set last.
Net Capsule::viscous_work(const membrane::ViscousLoad& c, const Net& v) {
  const auto clock = phases_.time("membrane");
  Net work;
  c.apply(v, work);
  replicate_sums(work);
  return work;
}

/// Returns rows of the double layer D (4.2) on every rank. Each row is provided by the rank that owns its point.
stokes::Rows<double> Capsule::double_rows_of(const Net& x, std::span<const int> targets) {
  const bool assembled = double_rows_.cols() > 0;
  std::vector<int> own;
  std::ranges::copy_if(targets, std::back_inserter(own), [&](int i) { return std::ranges::binary_search(own_points_, i); });
  stokes::Rows<double> made;
  if (!assembled) double_layer_->assemble(own, made);
  stokes::Rows<double> rows = stokes::Rows<double>::Zero(3 * static_cast<Eigen::Index>(targets.size()), 3 * x.rows());
  Eigen::Index next = 0;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const auto point = std::ranges::lower_bound(own_points_, targets[k]);
    if (point == own_points_.end() || *point != targets[k]) continue;
    rows.middleRows<3>(3 * static_cast<Eigen::Index>(k)) =
        assembled ? double_rows_.middleRows<3>(3 * (point - own_points_.begin())) : made.middleRows<3>(3 * next++);
  }
  ranks_.add({rows.data(), static_cast<std::size_t>(rows.size())});
  return rows;
}

void Capsule::forget_recycled() const {
  for (const Krylov* solver : {&velocity_solver_, &step_solver_, &inner_solver_}) solver->forget();
  if (tube_) tube_->forget_recycled();
  if (tractions_) tractions_->forget_recycled();
}

/// Moves x onto the prescribed volumes by Newton's method with V = x.(dV/dx)/3 (V: cubic form in x). Sets x to NaN if the iteration fails.
void Capsule::restore_volume(Net& x) {
  rigid_.place(x);
  if (parameters_.volume.constraint != "exact") return;
  const auto clock = phases_.time("volume");
  std::vector<double> missing(particles().size());  // volume to be added to each particle, divided by its prescribed volume V0
  Net c;
  const auto larger_than = [&](double bound) { return std::ranges::any_of(missing, [&](double m) { return !(std::abs(m) <= bound); }); };
  for (int k = 0; k < 6; ++k) {  // more than two corrections are needed only after a very long step
    const Net b = flux_vector(x);
    for (std::size_t p = 0; p < missing.size(); ++p) {
      const auto rows = particles()[p].block.rows(x);
      const double volume = (rows.rowwise() - rows.colwise().mean()).cwiseProduct(particles()[p].block.rows(b)).sum() / 3;
      missing[p] = rigid_.holds(p) ? 0 : 1 - volume / volume0_[p];
    }
    if (k > 1 && !larger_than(2e-15)) return;
    if (k == 5) break;
    if (k == 0) c = inflation(symmetric(solved(mass_.reference(), b)));
    for (std::size_t p = 0; p < missing.size(); ++p) {
      const spline::Block& block = particles()[p].block;
      block.rows(x) += missing[p] * volume0_[p] / block.rows(b).cwiseProduct(block.rows(c)).sum() * block.rows(c);
    }
  }
  if (larger_than(1e-12)) x.setConstant(std::numeric_limits<double>::quiet_NaN());
}

stokes::Evaluations Capsule::kernel_evaluations() const {
  stokes::Evaluations sum = layer_.evaluations();
  for (const auto* other : {&double_layer_, &site_layer_, &site_double_layer_})
    if (*other) sum += (*other)->evaluations();
  if (tube_) sum += tube_->kernel_evaluations();
  if (tractions_) sum += tractions_->kernel_evaluations();
  if (lattice_.solids) sum += lattice_.solids->evaluations();
  return sum;
}

}  // namespace tanktread::coupling
