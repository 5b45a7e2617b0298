#include "system/capsule.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "system/solids/bodies/rigid_tractions.hpp"
#include "system/symmetry.hpp"

namespace tanktread::coupling {

/// Sets the time. Cached results are kept unless the flow or the cell changes.
void Capsule::set_time(double time, double start) {
  const bool other_flow = surroundings_.flow.set_time(time, start), other_cell = parameters_.cell && deform_cell(time);
  if (other_flow || other_cell) latest_.reset();
}

/// Returns the virtual work of the loads and of the forces set by set_forces().
WorkOfLoads Capsule::work_of_loads(const Net& x) {
  WorkOfLoads found;
  found.work = membranes_.work(x, found.sums);
  for (const Net* of_forces : {&forces_.contacts, &forces_.fields})
    if (of_forces->size() > 0) found.work -= *of_forces;
  clear_rigid(particles(), found.work);  // rows of rigid bodies are 0; push_bodies() applies the forces on rigid bodies instead
  return found;
}

void Capsule::set_forces(Net Forces::* of, Net work) {
  if (same(work, forces_.*of)) return;
  forces_.*of = std::move(work);
  latest_.reset();
}

Net Capsule::response(Evaluation& at, const Net& work) {
  const Net base = at.velocity(), before = forces_.contacts;
  set_forces(&Forces::contacts, before.size() > 0 ? Net(before + work) : work);
  const Net change = velocity(at.x()) - base;
  set_forces(&Forces::contacts, before);
  return change;
}

/// Sets the contact forces on rigid bodies and the forces of their loads (Particle::loads), in addition to the prescribed forces on the bodies.
void Capsule::push_bodies(const Net& x) {
  if (bodies_.rigid.empty()) return;
  Net push = forces_.contacts;
  if (std::ranges::any_of(particles(), [](const Particle& one) { return one.rigid && !one.loads.empty(); })) {
    Net work = Net::Zero(x.rows(), 3);
    membranes_.complete_work(x, work);
    push = push.size() > 0 ? Net(push - work) : Net(-work);
  }
  bodies_.rigid.push(push);
}

/// Returns the load of the membranes at x. `known`: virtual work of the loads at x, computed here if it has no rows. On a lattice, particles may be
/// moved into the cell, which changes no load. If `volume` is given, it is set to the constraint on velocities at x, and remains inactive if the
/// volumes are free.
Net Capsule::membrane_load(const Net& x, WorkOfLoads& known, VolumeConstraint* volume) {
  Net* response = nullptr;
  if (volume && parameters_.constrained()) {
    volume->gradient = volume->response = volumes_.gradient(x);
    response = &volume->response;
  }
  const auto clock = phases_.time("membrane");
  if (parameters_.strong_load) {
    if (response) *response = membranes_.solved(std::move(*response));
    return targets_.collocated(membranes_.strong_load(x));
  }
  if (known.work.size() == 0) known = work_of_loads(x);
  return membranes_.load(x, known.work, response);
}

/// Returns velocity fields, with the symmetry of the scene, that do not change the shape: rotations of the meshes of drops and of membranes (4.22).
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
      if (const auto field = label_rotation(space_, one.block, membranes_.unstressed(), x, k, targets_.collocation())) all.push_back(*field);
  }
  return all;
}

std::shared_ptr<Evaluation> Capsule::evaluate(const Net& x, const Net& guess, double error) {
  const std::shared_ptr<Evaluation> before = latest_ && same(x, latest_->x()) ? latest_ : nullptr;
  if (before && before->solved(error)) return before;
  ++counts_.evaluations;
  latest_.reset();
  const auto e = std::make_shared<Evaluation>(*this, x, solve_shape(x, before ? before->velocity() : guess, error));
  if (e->velocity().allFinite()) latest_ = e;
  return e;
}

std::shared_ptr<Evaluation> Capsule::evaluate_on_demand(const Net& x, const Net& velocity, double distance) {
  if (!latest_ || !same(x, latest_->x())) return std::make_shared<Evaluation>(*this, x, velocity, evaluated_about(x, distance) ? latest_ : nullptr);
  return latest_;
}

/// Computes (4.2) in the cell. Tube and rigid bodies must be set to the shape x. Returns the velocity of the control points, and sets the other
/// quantities of `found`, whose allowed error is given.
Net Capsule::solve_in_cell(const Net& x, const Net& guess, SolvedShape& found) {
  if (!in_fluid(x)) return not_a_number(x);
  push_bodies(x);
  VolumeConstraint volume;
  const Net fluid = bodies_.tractions ? solve_first_kind(x, volume, found) : solve_second_kind(x, guess, volume, found);
  if (!interface_) return fluid;
  found.fluid = symmetric(fluid);
  const auto clock = phases_.time("interface motion");
  Net v = interface_->velocity(x, volume.active() ? volume.gradient : volumes_.gradient(x), fluid, found.slip);
  volumes_.constrain(v, volume);  // removes the small change of volume that the spline interpolation of the normal velocity causes
  return v;
}

/// Computes the fluid velocity of (4.2) step by step: the load of membranes and rigid bodies, the velocity that this load causes plus the ambient
/// velocity, the projection onto constant volumes, and the solution of the linear system for the velocity, if one is needed. The unknowns of rigid
/// bodies are the densities w of (2.23), which are replaced by the velocities of the bodies at the end. Sets `volume`, and
/// loads, unknowns and the response of a tube in `found`.
Net Capsule::solve_second_kind(const Net& x, const Net& guess, VolumeConstraint& volume, SolvedShape& found) {
  RigidParticles& rigid = bodies_.rigid;
  Net f = membrane_load(x, found.loads, &volume);
  rigid.add_load(f);
  found.load = f;
  Net v = explicit_velocity(x, f, {}, &found.response);
  rigid.add_load_correction(v);
  rigid.subtract_prescribed(v);
  volumes_.constrain(v, volume);
  if (has_velocity_system()) v = solve_velocity(x, f, volume, v, interface_ ? Net() : guess, found.error);
  found.unknowns = v;
  if (viscous()) found.load += membranes_.viscous_load(x, symmetric(v));
  if (rigid.empty()) return v;
  found.unknowns = symmetric(v);
  found.load += rigid.completing_load(v);
  rigid.store_density(v);
  return v;
}

/// Computes the fluid velocity of (4.2) as solve_second_kind() does, but with the tractions on rigid bodies as unknowns (2.40). Sets `volume`,
/// and loads, unknowns and the response of a tube in `found`.
Net Capsule::solve_first_kind(const Net& x, VolumeConstraint& volume, SolvedShape& found) {
  found.load = bodies_.tractions->all_rigid() ? Net(Net::Zero(x.rows(), 3)) : membrane_load(x, found.loads, &volume);
  Net v = explicit_velocity(x, found.load, {}, &found.response);
  volumes_.constrain(v, volume);
  found.unknowns = solve_tractions(x, volume, symmetric(v), found);
  return found.unknowns;
}

/// Returns v_inf - (1/mu) R^-1 A f of (4.2), with the ambient velocity v_inf, the collocation matrix R and the single layer A. Adds the velocity that
/// walls cause (add_walls) in response to the load f and, if given, to the velocity of the particles. Stores the response of a tube in `answer`, if
/// given, unless a linear system for the velocity follows, because the solution changes the response.
Net Capsule::explicit_velocity(const Net& x, const Net& f, const Net& particle_velocity, std::optional<Tube::Response>* answer) {
  Net u = layers_.apply_single(x, f);
  if (flow_at_targets()) {
    const bool known = duct_.tube && surroundings_.flow.duct();
    const stokes::AmbientFlow& flow = surroundings_.flow;
    u = (known ? flow.amplitude() * duct_.tube->ambient() : flow.velocities(targets_.values() * x)) - u / parameters_.viscosity;
    Tube::Response response = add_walls(x, f, particle_velocity, true, u);
    if (answer && duct_.tube && !has_velocity_system()) *answer = std::move(response);
    const auto clock = phases_.time("projection");
    return targets_.control_values(std::move(u));
  }
  Net v = surroundings_.flow.velocities(x);  // exact control values in an affine flow, because basis functions sum to one
  const auto clock = phases_.time("projection");
  v -= targets_.control_values(std::move(u)) / parameters_.viscosity;
  return v;
}

/// Returns whether all collocation sites are in the medium, inside the tube, in front of plates and outside posts, if there are any.
bool Capsule::in_fluid(const Net& x) const {
  const Net at_sites = targets_.at_sites() * x;
  if (duct_.tube && layout_.any(!duct_.tube->inside(at_sites, layout_.points()))) return false;
  if (surroundings_.solids) return surroundings_.solids->scene().solids->outside(at_sites);
  return stokes::contains(parameters_.medium.get(), at_sites);
}

/// Returns whether defect() uses (3.14), which does not require a solve for the velocity.
bool Capsule::defect_spares_system() const { return jacobian_.flows_by_system() && eliminates_walls(); }

/// Returns the defect P (w - B P u) - (1 - P) u of a velocity u (3.14). P is the volume projection (2.8). B v = w is the linear system for the
/// velocity v at x (see solve_velocity). Adds the viscous load due to u to the elastic load, so that one evaluation of the single layer is enough.
Net Capsule::defect(const Net& shape, const Net& given) {
  if (!defect_spares_system()) return velocity(shape) - given;
  ++counts_.evaluations;
  if (!shape.allFinite()) return not_a_number(shape);
  Net x = shape, u = given;
  place(x, &u);
  if (!in_fluid(x)) return not_a_number(x);
  VolumeConstraint volume;
  Net projected = u;
  WorkOfLoads work;
  Net f = membrane_load(x, work, &volume);
  volumes_.constrain(projected, volume);
  if (viscous()) f += membranes_.viscous_load(x, projected);
  Net residual = explicit_velocity(x, f, layers_.has_double() ? projected : Net(), nullptr) - projected;
  if (layers_.has_double()) {
    const auto clock = phases_.time("velocity system");
    residual += targets_.control_values(layers_.apply_double(x, projected));
  }
  volumes_.constrain(residual, volume);
  return symmetric(residual - (u - projected));
}

void Capsule::freeze(const Net& shape) {
  Net x = shape;
  const auto clock = phases_.time("assembly");
  place(x);
  ++counts_.assemblies;
  frozen_.assemble(shape, x);
  if (duct_.tube) duct_.tube->freeze();
}

void Capsule::linearise(const Net& x) {
  const auto clock = phases_.time("tangent");
  ++counts_.tangents;
  const auto e = evaluate_on_demand(x, {}, 0);
  jacobian_.linearise(x, slides() ? e->work() : Net(), e->load_sums(), e->slip());
}

Net Capsule::solve(double shift, const Net& r, double tolerance, const Secants& secants) {
  const auto clock = phases_.time("implicit solve");
  return jacobian_.solve(shift, jacobian_.velocity_product(r), tolerance, secants);
}

Net Capsule::correction(double shift, const Net& defect, double tolerance, const Secants& secants) {
  if (!defect_spares_system()) return Dynamics::correction(shift, defect, tolerance, secants);
  const auto clock = phases_.time("implicit solve");
  return jacobian_.solve(shift, shift * defect, tolerance, secants);
}

Net Capsule::jacobian_error(const Net& change, const Net& delta, double shift) {
  const auto clock = phases_.time("implicit solve");
  return (defect_spares_system() ? change : jacobian_.velocity_product(change)) + jacobian_.step_change(delta, shift, {}).rate / shift;
}

void Capsule::improve_start(Net& y, const Net& before, double shift) {
  const auto clock = phases_.time("tangent");
  jacobian_.improve_start(y, before, shift);
}

Net Capsule::mesh_motion(const Net& delta) {
  if (!interface_ || !interface_->relaxes()) return {};
  const auto clock = phases_.time("tangent");
  return interface_->derivative(Net::Zero(delta.rows(), 3), delta, {});
}

Net Capsule::derivative(const Net& x, const Net& v, const Net& delta) {
  if (!has_frozen()) return difference(x, v, delta);
  if (interface_) evaluate(x);  // because the change of the mesh motion depends on the fluid velocity
  const auto clock = phases_.time("stiffness");
  linearise(x);
  return symmetric(jacobian_.velocity_change(delta, {}).rate);
}

void Capsule::forget_recycled() const {
  velocity_solver_.forget();
  jacobian_.forget_recycled();
  if (duct_.tube) duct_.tube->forget_recycled();
  if (bodies_.tractions) bodies_.tractions->forget_recycled();
}

void Capsule::restore_constraints(Net& x) {
  bodies_.rigid.fit_to(x);
  if (parameters_.volume.constraint != VolumeConservation::exact) return;
  const auto clock = phases_.time("volume");
  volumes_.restore(x, [&](const Net& b) { return jacobian_.inflation(symmetric(membranes_.solved(b))); });
}

double Capsule::distance(const Net& from, const Net& to) const { return norm(Corotation::deformation(particles(), from, to)); }

bool Capsule::evaluated_about(const Net& x, double distance) const {
  if (!latest_) return false;
  Net moved = x - latest_->x();
  if (duct_.tube && !duct_.tube->fixed()) moved.col(0).array() -= moved.col(0).mean();
  return norm(moved) <= distance;
}

double Capsule::norm(const Net& displacement) const {
  double largest = 0;
  for (const Particle& particle : particles()) {
    const double norm = particle.block.rows(displacement).norm() / (particle.radius * std::sqrt(static_cast<double>(particle.block.n_points)));
    largest = norm <= largest ? largest : norm;  // keeps NaN
  }
  return largest;
}

stokes::Evaluations Capsule::kernel_evaluations() const {
  stokes::Evaluations sum = layers_.evaluations() + frozen_.evaluations();
  if (bodies_.tractions) sum += bodies_.tractions->kernel_evaluations();  // includes the tube
  else if (duct_.tube) sum += duct_.tube->kernel_evaluations();
  if (surroundings_.solids) sum += surroundings_.solids->evaluations();
  return sum;
}

}  // namespace tanktread::coupling
