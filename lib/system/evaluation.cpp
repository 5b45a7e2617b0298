#include "system/evaluation.hpp"

#include <utility>

#include "base/indices.hpp"
#include "system/capsule.hpp"

namespace tanktread::coupling {

Evaluation::Evaluation(Capsule& system, Net x, Net velocity, std::shared_ptr<Evaluation> near)
    : system_(&system), x_(std::move(x)), given_(std::move(velocity)), near_(std::move(near)) {}

Evaluation::Evaluation(Capsule& system, Net x, SolvedShape solution)
    : system_(&system), x_(std::move(x)), solved_(true), known_(std::move(solution)) {}

void Evaluation::solve(double error) {
  if (!solved(error)) *this = *system_->evaluate(x_, solved_ ? known_.velocity : given_, error);
}

void Evaluation::require_solution() {
  if (!solved_) solve();
}

const Net& Evaluation::velocity() {
  if (!solved_ && given_.size() > 0) return given_;
  require_solution();
  return known_.velocity;
}

const Net& Evaluation::fluid_velocity() {
  if (!system_->slides()) return velocity();
  if (!solved_ && near_) return near_->fluid_velocity();
  require_solution();
  return known_.fluid;
}

const Net& Evaluation::solved_fluid_velocity() {
  if (system_->slides()) require_solution();
  return fluid_velocity();
}

const WorkOfLoads& Evaluation::work_of_loads() {
  if (!system_->solver().equations().empty()) require_solution();  // part of the work depends on the unknowns
  if (known_.virtual_work.work.size() == 0) known_.virtual_work = system_->solver().work_of_loads(x_);
  return known_.virtual_work;
}

const std::vector<Net>& Evaluation::load_sums() {
  return system_->solver().membranes().loads().n_sums() > 0 ? work_of_loads().sums : known_.virtual_work.sums;
}

const Net& Evaluation::load() {
  VelocitySolver& solver = system_->solver();
  if (solver.load_depends_on_unknowns()) require_solution();
  else if (known_.load.size() == 0) known_.load = solver.membrane_load(x_, known_.virtual_work);
  return known_.load;
}

const BlockVector& Evaluation::solution() {
  if (!system_->solver().equations().empty()) require_solution();
  return known_.solution;
}

std::vector<double> Evaluation::values_of_added(std::size_t k) { return system_->solver().equations()[k].values(x_, solution()); }

Mat3 Evaluation::stresslet_between_particles() {
  solution();  // also computes the work of the added equations
  Mat3 moment = Mat3::Zero();
  if (known_.added_work.size() == 0) return moment;
  for (const Particle& one : system_->particles())
    moment += one.block.rows(known_.added_work).colwise().sum().transpose() *
              surface::measures(*one.space, one.block.rows(x_)).centroid.transpose();
  return coupling::stresslet(moment);
}

const RigidParticles& Evaluation::rigid() {
  if (!solved_ && near_) return near_->rigid();
  require_solution();
  return known_.rigid ? *known_.rigid : system_->solver().rigid();
}

/// Computes the load and the unknowns from the velocity passed to the constructor, if there is one and the unknowns are velocities. Otherwise solves
/// the linear system.
void Evaluation::find_unknowns() {
  if (known_.unknowns.size() > 0) return;
  if (given_.size() == 0 || !system_->solver().unknowns_are_velocities()) require_solution();
  if (solved_) return;
  known_.unknowns = given_;
  known_.load = system_->solver().membrane_load(x_, known_.virtual_work);
  if (system_->solver().viscous()) known_.load += system_->solver().membranes().load(x_, viscous_work());
}

const Tube::Response& Evaluation::response() {
  if (!known_.response) find_unknowns();
  system_->solver().place(x_);
  if (!known_.response) known_.response = system_->tube()->respond(known_.load, known_.unknowns);
  return *known_.response;
}

Evaluation::SolidFlow Evaluation::solid_flow() {
  find_unknowns();
  system_->solver().place(x_);
  SolidResponse& solids = *system_->solids();
  SolidFlow found{.flow = {}, .caused = solids.respond(known_.load, known_.unknowns)};
  found.flow = found.caused + solids.empty();
  found.caused_integral = solids.flow_integral(found.caused, known_.load, known_.unknowns);
  found.velocity_integral = found.caused_integral + solids_flow_integral(solids.scene(), solids.empty());
  return found;
}

FluidWalls::Response Evaluation::wall_response() {
  FluidWalls::Response found;
  if (system_->tube()) found.tube = response();
  if (system_->solids()) found.solids = solid_flow().flow;
  return found;
}

Tube::Checks Evaluation::checks() {
  const Tube::Response& found = response();
  return system_->tube()->checks(known_.load, known_.unknowns, found);
}

const Net& Evaluation::viscous_work() {
  if (viscous_work_.size() == 0) viscous_work_ = system_->solver().membranes().viscous_work(x_, solved_fluid_velocity());
  return viscous_work_;
}

Mat3 Evaluation::stresslet(std::size_t p) {
  Capsule& system = *system_;
  const Particle& particle = system.particles()[p];
  const auto own = [&](const Net& net) { return particle.block.rows(net); };
  Mat3 moment;
  if (particle.rigid) {
    moment = particle.by_traction ? moment_by_traction(p) : rigid().load_moment(p);
  } else {
    Net of_particle = own(virtual_work());
    if (system.solver().viscous()) of_particle += own(viscous_work());
    moment = of_particle.transpose() * own(x_);  // first moment int df x dGamma of the load, with x = sum N_A x_A
    const bool has_others = system.solver().has_forces() || !system.solver().equations().empty();
    if (!particle.loads.empty() || has_others)  // refers the moment to the centroid, because the load has a net force
      moment -= of_particle.colwise().sum().transpose() * surface::measures(*particle.space, own(x_)).centroid.transpose();
  }
  if (const double contrast = viscosity_contrast(particle); contrast != 0) {
    const Net v = particle.rigid ? rigid().density(p) : Net(own(solved_fluid_velocity()));
    Net flux;
    system.geometry().volume_gradient(x_, indices(particle.block.n_elements, particle.block.first_element), flux);
    moment -= 2 * contrast * system.parameters().viscosity * v.transpose() * own(flux);
  }
  return coupling::stresslet(moment);
}

Mat3 Evaluation::moment_by_traction(std::size_t p) {
  if (!solved_ && near_) return near_->moment_by_traction(p);
  require_solution();
  system_->evaluate(x_, known_.velocity, known_.error);  // solves again if another shape was solved last
  system_->solver().place(x_);
  return system_->solver().moment_by_traction(p);
}

double Evaluation::membrane_dissipation(std::size_t p) {
  if (!system_->solver().viscous()) return 0;
  const spline::Block& block = system_->particles()[p].block;
  return block.rows(solved_fluid_velocity()).cwiseProduct(block.rows(viscous_work())).sum();
}

double Evaluation::load_energy(std::size_t p) { return system_->solver().membranes().loads().energy(x_, load_sums(), p); }

}  // namespace tanktread::coupling
