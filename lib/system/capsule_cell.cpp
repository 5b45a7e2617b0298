// Functions of Capsule for particles in a periodic cell, among solids in the cell, and in a tube.

#include <memory>
#include <vector>

#include "system/capsule.hpp"
#include "system/solids/rigid_tractions.hpp"

namespace tanktread::coupling {

/// Sets the cell as deformed by the flow until `time` (2.51). Returns whether the cell has changed. The cell of a duct is constant.
bool Capsule::deform_cell(double time) {
  if (tube_) {
    lattice_.cell = tube_->cell();
    return false;
  }
  const Mat3 deformation = lattice_.solids ? Mat3(Mat3::Identity()) : flow_.deformation(time);  // a cell with walls or posts is not deformed
  const stokes::PeriodicCell now(deformation * parameters_.cell->vectors(), parameters_.cell->n());
  if (lattice_.cell && *lattice_.cell == now) return false;
  lattice_.cell = now;
  layers_.repeat(now);
  if (tractions_) tractions_->repeat(now);
  return true;
}

std::vector<Vec3> Capsule::put_into_cell(Net& x) {
  std::vector<Vec3> shifts;
  const Vec3 middle = cell_origin(x);
  if (tube_ && !tube_->fixed()) tube_place_.origin = middle[0];
  for (const Particle& particle : particles()) {
    auto rows = particle.block.rows(x);
    shifts.push_back(lattice_.cell->shift(rows.colwise().mean().transpose() - middle));
    rows.rowwise() -= shifts.back().transpose();
  }
  return shifts;
}

void Capsule::place(const Net& x) {
  if (tube_place_.net.rows() == x.rows() && tube_place_.net == x && tube_place_.origin == tube_place_.origin_of_net) return;
  tube_->place(x, tube_place_.origin);
  tube_place_.net = x, tube_place_.origin_of_net = tube_place_.origin;
}

/// Returns the middle of the cell. In a straight tube, whose wall moves with the particles, it is the mean of all particles' control points, even if
/// they are far apart.
Vec3 Capsule::cell_origin(const Net& x) const {
  if (!tube_) return Vec3::Zero();
  if (tube_->fixed()) return (tube_->wall().start + tube_->wall().end) / 2 * Vec3::UnitX();
  return x.col(0).mean() * Vec3::UnitX();
}

/// Adds to the rank-owned rows of u the velocity (2.47) that the solids cause at the targets in response to the load f and the velocity `moves` of
/// the particles. If `with_empty`, includes the flow of the solids without particles.
void Capsule::add_solids(const Net& x, const Net& f, const Net& moves, bool with_empty, Net& u) {
  const auto clock = phases_.time("wall");
  place_among_solids(x);
  Solids::Flow flow = lattice_.solids->respond(f, moves);
  if (with_empty) flow = flow + lattice_.solids->empty();
  Net part = targets_.zero();
  lattice_.solids->velocities(flow, part);
  targets_.gather(false, part);
  u += part;
}

/// Returns the control values of the velocity by which a tube or solids respond to a load f and a velocity v.
Net Capsule::velocity_by_walls(const Net& x, const Net& f, const Net& v) {
  if (tube_) return targets_.collocation().solve(tube_->respond(f, v).velocity);
  Net u = targets_.zero();
  add_solids(x, f, v, false, u);
  return targets_.serial_control_values(u);
}

/// Constructs the response of plates and posts, if there are any.
void Capsule::put_among_solids() {
  if (!parameters_.solids) return;
  lattice_.solids = std::make_unique<SolidResponse>(*parameters_.solids, space_, flow_);
  lattice_.solids->set_reference(membranes_.unstressed(), measure(), measured_on_present(particles()));
  if (tractions_) tractions_->put_among(*lattice_.solids);
  lattice_.solids->set_contrasts(viscosity_contrasts_of_points(particles()));
}

void Capsule::place_among_solids(const Net& x) {
  lattice_.solids->place(x, targets_.values() * x, targets_.own());
}

/// Evaluates the shape with each particle moved by a lattice vector so that its mean is in the cell, and transfers the velocities back.
Net Capsule::in_cell(Evaluation& e, const Net& guess) {
  if (!lattice_.cell || !e.x().allFinite()) return solve(e, e.x(), guess);
  Net x = e.x();
  const std::vector<Vec3> shifts = put_into_cell(x);
  rigid_.enter(shifts, tube_ ? Mat3::Zero() : flow_.cell_gradient());
  Net slower = guess;
  const auto faster_by = [&](std::size_t p) { return faster_beyond(shifts[p]); };
  for (std::size_t p = 0; p < shifts.size() && guess.size() > 0; ++p) particles()[p].block.rows(slower).rowwise() -= faster_by(p).transpose();
  Net v = solve(e, std::move(x), slower);
  for (std::size_t p = 0; p < shifts.size(); ++p) {
    const Vec3 faster = faster_by(p);
    for (Net* net : {&v, &e.fluid_})
      if (net->size() > 0) particles()[p].block.rows(*net).rowwise() += faster.transpose();
    rigid_.carry(p, shifts[p], faster);
  }
  return v;
}

}  // namespace tanktread::coupling
