// Functions of Capsule for particles in a periodic cell, among solids in the cell, and in a tube.

#include <memory>
#include <vector>

#include "system/capsule.hpp"
#include "system/solids/bodies/rigid_tractions.hpp"

namespace tanktread::coupling {

/// Sets the cell as deformed by the flow until `time` (2.51). Returns whether the cell has changed. The cell of a duct is constant.
bool Capsule::deform_cell(double time) {
  if (duct_.tube) {
    surroundings_.cell = duct_.tube->cell();
    return false;
  }
  // A cell with walls or posts is not deformed.
  const Mat3 deformation = surroundings_.solids ? Mat3(Mat3::Identity()) : surroundings_.flow.deformation(time);
  const stokes::PeriodicCell now(deformation * parameters_.cell->vectors(), parameters_.cell->n());
  if (surroundings_.cell && *surroundings_.cell == now) return false;
  surroundings_.cell = now;
  layers_.repeat(now);
  if (bodies_.tractions) bodies_.tractions->repeat(now);
  return true;
}

Capsule::CellMove Capsule::move_into_cell(Net& x, Net* v) const {
  CellMove move;
  if (!surroundings_.cell) return move;
  const Vec3 middle = cell_origin(x);
  if (duct_.tube && !duct_.tube->fixed()) move.origin = middle[0];
  for (const Particle& particle : particles()) {
    auto rows = particle.block.rows(x);
    CellShift& shift = move.shifts.emplace_back(surroundings_.cell->shift(rows.colwise().mean().transpose() - middle));
    if (!duct_.tube) shift.velocity = surroundings_.flow.cell_gradient() * shift.position;
    rows.rowwise() -= shift.position.transpose();
    if (v && v->size() > 0) particle.block.rows(*v).rowwise() -= shift.velocity.transpose();
  }
  return move;
}

void Capsule::place(Net& x, Net* v) {
  const std::optional<double> origin = move_into_cell(x, v).origin;
  set_tube_shape(x, origin);
}

/// Sets the tube, if there is one, to the shape x. `origin`: see CellMove.
void Capsule::set_tube_shape(const Net& x, std::optional<double> origin) {
  if (!duct_.tube || (same(duct_.net, x) && duct_.origin == origin)) return;
  duct_.net = {};  // no shape is set if the next call throws
  duct_.tube->set_shape(x, origin);
  duct_.net = x, duct_.origin = origin;
}

/// Returns the middle of the cell. In a straight tube, whose wall moves with the particles, it is on the x1 axis, at the mean x1 of all control
/// points, even if the particles are far apart.
Vec3 Capsule::cell_origin(const Net& x) const {
  if (!duct_.tube) return Vec3::Zero();
  if (duct_.tube->fixed()) return (duct_.tube->wall().start + duct_.tube->wall().end) / 2 * Vec3::UnitX();
  return x.col(0).mean() * Vec3::UnitX();
}

/// Adds to u, a velocity at the targets, the velocity that plates and posts (2.47), or a tube whose wall traction is eliminated (2.5), cause in
/// response to the load f and the velocity v of the particles. The tube must be set to the shape x. If `with_empty`, also adds the velocity that the
/// solids cause without particles. Returns the response of the tube.
Tube::Response Capsule::add_walls(const Net& x, const Net& f, const Net& v, bool with_empty, Net& u) {
  if (solids()) {
    const auto clock = phases_.time("wall");
    set_solid_shape(x);
    Solids::Flow flow = solids()->respond(f, v);
    if (with_empty) flow = flow + solids()->empty();
    Net part = targets_.zero();
    solids()->velocities(flow, part);
    targets_.gather(false, part);
    u += part;
  }
  if (!duct_.tube || !eliminates_walls()) return {};
  Tube::Response response = duct_.tube->respond(f, v);
  u += response.velocity;
  return response;
}

void Capsule::set_solid_shape(const Net& x) {
  surroundings_.solids->set_shape(x, targets_.values() * x, targets_.own());
}

/// Solves (4.2) at a shape, with each particle replaced by its image in the cell of a lattice, and converts the velocities of the images to
/// velocities of the particles. `guess`: see evaluate(). `error`: see Evaluation::solve.
SolvedShape Capsule::solve_shape(const Net& shape, const Net& guess, double error) {
  if (!shape.allFinite()) return {.error = error, .velocity = not_a_number(shape)};
  SolvedShape found{.error = error};
  Net x = shape, v = guess;
  const auto [shifts, origin] = move_into_cell(x, &v);
  bodies_.rigid.move_into_cell(shifts);
  bodies_.rigid.fit_to(x);
  set_tube_shape(x, origin);
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
