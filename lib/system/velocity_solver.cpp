#include "system/velocity_solver.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <utility>

#include "system/dynamics.hpp"
#include "system/solids/bodies/rigid_tractions.hpp"

namespace tanktread::coupling {

bool VelocitySolver::set_time(double time, double start) {
  const bool other_flow = flow_.set_time(time, start), other_cell = parameters_.cell && deform_cell(time);
  return other_flow || other_cell;
}

bool VelocitySolver::set_forces(Net Forces::* of, Net work) {
  if (same(work, forces_.*of)) return false;
  forces_.*of = std::move(work);
  return true;
}

WorkOfLoads VelocitySolver::work_of_loads(const Net& x) {
  WorkOfLoads found;
  found.work = membranes_.work(x, found.sums);
  for (const Net* of_forces : forces_.all())
    if (of_forces->size() > 0) found.work -= *of_forces;
  clear_rigid(particles(), found.work);  // rows of rigid bodies are 0; push_bodies() applies the forces on rigid bodies instead
  return found;
}

/// Sets the contact forces on rigid bodies and the forces of their loads (Particle::loads), in addition to the prescribed forces on the bodies.
void VelocitySolver::push_bodies(const Net& x) {
  if (bodies_.rigid.empty()) return;
  Net push = forces_.contacts;  // there are no fields on rigid bodies
  if (std::ranges::any_of(particles(), [](const Particle& one) { return one.rigid && !one.loads.empty(); })) {
    Net work = Net::Zero(x.rows(), 3);
    membranes_.complete_work(x, work);
    push = push.size() > 0 ? Net(push - work) : Net(-work);
  }
  bodies_.rigid.push(push);
}

Net VelocitySolver::membrane_load(const Net& x, WorkOfLoads& known, VolumeProjection* volume) {
  Net* direction = nullptr;
  if (volume && parameters_.constrained()) {
    const Net gradient = volumes_.gradient(x);
    *volume = volumes_.projection(gradient, gradient);
    direction = &volume->direction;
  }
  const auto clock = phases_.time("membrane");
  if (parameters_.strong_load) {
    if (has_forces()) throw std::logic_error("the strong form has no load due to additional forces");
    if (direction) *direction = membranes_.solved(std::move(*direction));
    return targets_.collocated(membranes_.strong_load(x));
  }
  if (known.work.size() == 0) known = work_of_loads(x);
  return membranes_.load(x, known.work, direction);
}

/// Computes (4.2) in the cell. All walls and the rigid bodies must be set to the shape x. Returns the velocity of the control points, and sets the
/// other quantities of `found`, whose allowed error is given.
Net VelocitySolver::solve_in_cell(const Net& x, const Net& guess, SolvedShape& found) {
  if (!in_fluid(x)) return not_a_number(x);
  push_bodies(x);
  VolumeProjection volume;
  const Net fluid = bodies_.tractions ? solve_first_kind(x, volume, found) : solve_second_kind(x, guess, volume, found);
  if (!interface_) return fluid;
  found.fluid = symmetric(fluid);
  const auto clock = phases_.time("interface motion");
  Net v = interface_->velocity(x, volume.gradient.size() > 0 ? volume.gradient : volumes_.gradient(x), fluid, found.slip);
  volume.apply(v);  // removes the small change of volume that the spline interpolation of the normal velocity causes
  return v;
}

/// Computes the fluid velocity of (4.2) step by step: the load of membranes and rigid bodies, the velocity that this load causes plus the ambient
/// velocity, and the solution of the linear system for the velocity or, without one, the projection onto constant volumes. The unknowns of rigid
/// bodies are the densities w of (2.23), which are replaced by the velocities of the bodies at the end. Sets `volume`, and
/// loads, unknowns and the response of a tube in `found`.
Net VelocitySolver::solve_second_kind(const Net& x, const Net& guess, VolumeProjection& volume, SolvedShape& found) {
  RigidParticles& rigid = bodies_.rigid;
  Net f = membrane_load(x, found.loads, &volume);
  rigid.add_load(f);
  found.load = f;
  Net v = explicit_velocity(x, f, {}, &found.response);
  rigid.add_load_correction(v);
  rigid.subtract_prescribed(v);
  if (has_velocity_system()) v = solve_velocity(x, f, volume, v, interface_ ? Net() : guess, found.error);
  else volume.apply(v);
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
Net VelocitySolver::solve_first_kind(const Net& x, VolumeProjection& volume, SolvedShape& found) {
  found.load = bodies_.tractions->all_rigid() ? Net(Net::Zero(x.rows(), 3)) : membrane_load(x, found.loads, &volume);
  Net v = explicit_velocity(x, found.load, {}, nullptr);
  volume.apply(v);
  found.unknowns = solve_tractions(x, volume, symmetric(v), found);
  return found.unknowns;
}

/// Returns v_inf - (1/mu) R^-1 A f of (4.2), with the ambient velocity v_inf, the collocation matrix R and the single layer A. Adds the velocity that
/// walls cause (add_walls) in response to the load f and, if given, to the velocity of the particles. Stores the response of a tube in `answer`, if
/// given, unless a linear system for the velocity follows, because the solution changes the response.
Net VelocitySolver::explicit_velocity(const Net& x, const Net& f, const Net& particle_velocity, std::optional<Tube::Response>* answer) {
  Net u = layers_.apply_single(x, f);
  if (flow_at_targets()) {
    const bool known = tube_ && flow_.duct();
    u = (known ? flow_.amplitude() * tube_->ambient() : flow_.velocities(targets_.values() * x)) - u / parameters_.viscosity;
    Tube::Response response = add_walls(f, particle_velocity, true, u);
    if (answer && tube_ && !has_velocity_system()) *answer = std::move(response);
    const auto clock = phases_.time("projection");
    return targets_.control_values(std::move(u));
  }
  Net v = flow_.velocities(x);  // exact control values in an affine flow, because basis functions sum to one
  const auto clock = phases_.time("projection");
  v -= targets_.control_values(std::move(u)) / parameters_.viscosity;
  return v;
}

/// Returns whether all collocation sites are in the medium, inside the tube, in front of plates and outside posts, if there are any.
bool VelocitySolver::in_fluid(const Net& x) const {
  const Net at_sites = targets_.at_sites() * x;
  return walls_.contain(at_sites, layout_) && stokes::contains(parameters_.medium.get(), at_sites);
}

Net VelocitySolver::defect(const Net& shape, const Net& given) {
  assert(unknowns_are_velocities() && eliminates_walls());
  Net x = shape, u = given;
  place(x, &u);
  if (!in_fluid(x)) return not_a_number(x);
  VolumeProjection volume;
  Net projected = u;
  WorkOfLoads work;
  Net f = membrane_load(x, work, &volume);
  volume.apply(projected);
  if (viscous()) f += membranes_.viscous_load(x, projected);
  Net residual = explicit_velocity(x, f, layers_.has_double() ? projected : Net(), nullptr) - projected;
  if (layers_.has_double()) {
    const auto clock = phases_.time("velocity system");
    residual += targets_.control_values(layers_.apply_double(x, projected));
  }
  volume.apply(residual);
  return symmetric(residual - (u - projected));
}

void VelocitySolver::forget_recycled() const {
  krylov_.forget();
  walls_.forget_recycled();
  if (bodies_.tractions) bodies_.tractions->forget_recycled();
}

stokes::Evaluations VelocitySolver::kernel_evaluations() const {
  const RigidTractions* const bodies = bodies_.tractions.get();
  return layers_.evaluations() + (bodies ? bodies->kernel_evaluations() : walls_.evaluations());  // bodies->kernel_evaluations() includes the walls
}

}  // namespace tanktread::coupling
