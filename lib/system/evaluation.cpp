#include "system/evaluation.hpp"

#include <utility>

#include "base/indices.hpp"
#include "system/capsule.hpp"

namespace tanktread::coupling {

Evaluation::Evaluation(Capsule& system, Net x, Net velocity, std::shared_ptr<Evaluation> near)
    : system_(&system), x_(std::move(x)), known_(std::move(velocity)), near_(std::move(near)) {}

void Evaluation::solve(double error) {
  if (solved_ && error_ <= error) return;
  const std::shared_ptr<Evaluation> found = system_->evaluate(x_, solved_ ? velocity_ : known_, error);
  Net known = std::move(known_);
  *this = *found;
  known_ = std::move(known);
}

void Evaluation::solve_again() {
  known_ = velocity_;
  solved_ = false;
  solve(error_);
}

void Evaluation::require_solution() {
  if (!solved_) solve();
}

const Net& Evaluation::velocity() {
  if (!solved_ && known_.size() > 0) return known_;
  require_solution();
  return velocity_;
}

const Net& Evaluation::fluid_velocity() {
  if (!system_->slides()) return velocity();
  if (!solved_ && near_) return near_->fluid_velocity();
  require_solution();
  return fluid_;
}

const Net& Evaluation::solved_fluid_velocity() {
  if (system_->slides()) require_solution();
  return fluid_velocity();
}

const Net& Evaluation::work() {
  if (work_.size() == 0) work_ = system_->work_of_loads(x_, load_sums_);
  return work_;
}

const std::vector<Net>& Evaluation::load_sums() {
  if (system_->membranes_.loads().n_sums() > 0) work();
  return load_sums_;
}

const Net& Evaluation::load() {
  if (load_.size() == 0) {
    if (!system_->bodies_.rigid.empty() || system_->viscous()) require_solution();  // because the load depends on the solution of the velocity system
    else load_ = system_->membrane_load(*this, x_);
  }
  return load_;
}

const RigidParticles& Evaluation::rigid() {
  if (!solved_ && near_) return near_->rigid();
  require_solution();
  return rigid_ ? *rigid_ : system_->bodies_.rigid;
}

/// Computes the load and the unknowns from the velocity if it is known; otherwise solves for them.
void Evaluation::find_unknowns() {
  if (known_.size() == 0 || !system_->unknowns_are_velocities()) require_solution();
  if (solved_) return;
  unknowns_ = known_;
  load_ = system_->membrane_load(*this, x_);
  if (system_->viscous()) load_ += system_->membranes_.load(x_, viscous_work());
}

const Tube::Response& Evaluation::response() {
  if (!response_) find_unknowns();
  Net inside = x_;
  system_->place(inside);
  if (!response_) response_ = system_->duct_.tube->respond(load_, unknowns_);
  return *response_;
}

Evaluation::SolidFlow Evaluation::solid_flow() {
  find_unknowns();
  Net inside = x_;
  system_->move_into_cell(inside);
  system_->set_solid_shape(inside);
  SolidResponse& solids = *system_->solids();
  SolidFlow found{.flow = {}, .caused = solids.respond(load_, unknowns_)};
  found.flow = found.caused + solids.empty();
  found.caused_integral = solids.flow_integral(found.caused, load_, unknowns_);
  found.velocity_integral = found.caused_integral + solids_flow_integral(solids.scene(), solids.empty());
  return found;
}

Tube::Checks Evaluation::checks() {
  const Tube::Response& known = response();
  return system_->duct_.tube->checks(load_, unknowns_, known);
}

const Net& Evaluation::viscous_work() {
  if (viscous_work_.size() == 0) viscous_work_ = system_->membranes_.viscous_work(x_, solved_fluid_velocity());
  return viscous_work_;
}

Mat3 Evaluation::stresslet(std::size_t p) {
  Capsule& system = *system_;
  const Particle& particle = system.particles()[p];
  const auto own = [&](const Net& net) { return particle.block.rows(net); };
  Mat3 moment;
  if (particle.rigid) {
    moment = particle.by_traction ? system.moment_by_traction(*this, p) : rigid().load_moment(p);
  } else {
    Net of_particle = own(work());
    if (system.viscous()) of_particle += own(viscous_work());
    moment = of_particle.transpose() * own(x_);  // first moment int df x dGamma of the load, with x = sum N_A x_A
    if (!particle.loads.empty() || system.has_forces())  // refers the moment to the centroid, because the load has a net force
      moment -= of_particle.colwise().sum().transpose() * surface::measures(*particle.space, own(x_)).centroid.transpose();
  }
  if (const double contrast = viscosity_contrast(particle); contrast != 0) {
    const Net v = particle.rigid ? rigid().density(p) : Net(own(solved_fluid_velocity()));
    Net flux;
    system.geometry().volume_gradient(x_, indices(particle.block.n_elements, particle.block.first_element), flux);
    moment -= 2 * contrast * system.parameters_.viscosity * v.transpose() * own(flux);
  }
  return coupling::stresslet(moment);
}

double Evaluation::membrane_dissipation(std::size_t p) {
  if (!system_->viscous()) return 0;
  const spline::Block& block = system_->particles()[p].block;
  return block.rows(solved_fluid_velocity()).cwiseProduct(block.rows(viscous_work())).sum();
}

double Evaluation::load_energy(std::size_t p) { return system_->membranes_.loads().energy(x_, load_sums(), p); }

}  // namespace tanktread::coupling
