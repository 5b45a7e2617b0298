// Functions of VelocitySolver for particles in a periodic cell, among solids in the cell, and in a tube.

#include <memory>
#include <vector>

#include "system/dynamics.hpp"
#include "system/velocity_solver.hpp"
#include "system/solids/bodies/rigid_tractions.hpp"

namespace tanktread::coupling {

/// Sets the cell as deformed by the flow until `time` (2.51). Returns whether the cell has changed. The cell of a duct is constant.
bool VelocitySolver::deform_cell(double time) {
  if (tube_) {
    cell_ = tube_->cell();
    return false;
  }
  // A cell with walls or posts is not deformed.
  const Mat3 deformation = walls_.any() ? Mat3(Mat3::Identity()) : flow_.deformation(time);
  const stokes::PeriodicCell now(deformation * parameters_.cell->vectors(), parameters_.cell->n());
  if (cell_ && *cell_ == now) return false;
  cell_ = now;
  layers_.repeat(now);
  if (bodies_.tractions) bodies_.tractions->repeat(now);
  return true;
}

VelocitySolver::CellMove VelocitySolver::move_into_cell(Net& x, Net* v) const {
  CellMove move;
  if (!cell_) return move;
  const Vec3 middle = cell_origin(x);
  if (tube_ && !tube_->fixed()) move.origin = middle[0];
  for (const Particle& particle : particles()) {
    auto rows = particle.block.rows(x);
    CellShift& shift = move.shifts.emplace_back(cell_->shift(rows.colwise().mean().transpose() - middle));
    if (!tube_) shift.velocity = flow_.cell_gradient() * shift.position;
    rows.rowwise() -= shift.position.transpose();
    if (v && v->size() > 0) particle.block.rows(*v).rowwise() -= shift.velocity.transpose();
  }
  return move;
}

void VelocitySolver::place(Net& x, Net* v) {
  const std::optional<double> origin = move_into_cell(x, v).origin;
  // Fits a copy of the bodies to x, which changes x as in solve(). If solve() has set the walls to this shape, set_shape() then has nothing to do.
  if (!bodies_.rigid.empty()) RigidParticles(bodies_.rigid).fit_to(x);
  walls_.set_shape(x, targets_, origin);
}

/// Returns the middle of the cell. In a straight tube, whose wall moves with the particles, it is on the x1 axis, at the mean x1 of all control
/// points, even if the particles are far apart.
Vec3 VelocitySolver::cell_origin(const Net& x) const {
  if (!tube_) return Vec3::Zero();
  if (tube_->fixed()) return (tube_->wall().start + tube_->wall().end) / 2 * Vec3::UnitX();
  return x.col(0).mean() * Vec3::UnitX();
}

/// Adds to u, a velocity at the targets, the velocity that plates and posts (2.47), or a tube whose wall traction is eliminated (2.5), cause in
/// response to the load f and the velocity v of the particles. The walls must be set to the shape. If `with_empty`, also adds the velocity that the
/// solids cause without particles. Returns the response of the tube.
Tube::Response VelocitySolver::add_walls(const Net& f, const Net& v, bool with_empty, Net& u) {
  if (!walls_.any()) return {};
  const auto clock = phases_.time("wall");
  FluidWalls eliminated = walls_;
  if (!eliminates_walls()) eliminated.tube = nullptr;
  FluidWalls::Response response = eliminated.respond(f, v, with_empty);
  eliminated.add_velocity(response, targets_, u);
  return response.tube;
}

/// Solves (4.2) at a shape, with each particle replaced by its image in the cell of a lattice, and converts the velocities of the images to
/// velocities of the particles. `guess`: see solve(). `error`: see SolvedShape.
SolvedShape VelocitySolver::solve(const Net& shape, const Net& guess, double error) {
  if (!shape.allFinite()) return {.error = error, .velocity = not_a_number(shape)};
  SolvedShape found{.error = error};
  Net x = shape, v = guess;
  const auto [shifts, origin] = move_into_cell(x, &v);
  bodies_.rigid.move_into_cell(shifts);
  bodies_.rigid.fit_to(x);
  walls_.set_shape(x, targets_, origin);
  v = solve_in_cell(x, v, found);
  for (std::size_t p = 0; p < shifts.size(); ++p)
    for (Net* net : {&v, &found.fluid})
      if (net->size() > 0) particles()[p].block.rows(*net).rowwise() += shifts[p].velocity.transpose();
  bodies_.rigid.move_out_of_cell(shifts);
  found.velocity = symmetric(v);
  if (!bodies_.rigid.empty()) found.rigid = bodies_.rigid;
  return found;
}

}  // namespace tanktread::coupling
