#include "system/equations/particles.hpp"

namespace tanktread::coupling {

namespace {

/// Sets the rows of the particles that are rigid bodies, or of those that are not, in `to`, which gets rows of zeros if it has none.
void set_rows(std::span<const Particle> particles, bool rigid, const Net& from, Net& to) {
  if (to.size() == 0) to = Net::Zero(from.rows(), 3);
  for (const Particle& one : particles)
    if (one.rigid.has_value() == rigid) one.block.rows(to) = one.block.rows(from);
}

/// Adds the rows of the particles that are rigid bodies, or of those that are not, to r.
void add_rows(std::span<const Particle> particles, bool rigid, const Net& rows, BlockVector& r) {
  Eigen::Map<Net> all = System::particles(r);
  for (const Particle& one : particles)
    if (one.rigid.has_value() == rigid) all.middleRows(one.block.first_point, one.block.n_points) += one.block.rows(rows);
}

}  // namespace

void DeformableVelocities::add_sources(const BlockVector& x, Given given, Sources& to) const {
  const Net v = System::particles(x);
  if (has_double_ && !v.isZero(0)) set_rows(particles_, false, v, to.density);
  if (given == Given::included && load_.size() > 0) to.add_load(load_);
  if (membranes_.viscous() && !v.isZero(0)) {
    Net moving = v;
    clear_rigid(particles_, moving);
    to.add_load(membranes_.viscous_load(x_, moving));
  }
}

void DeformableVelocities::add_residual(const BlockVector& x, const Sources&, const SurfaceVelocity& u, Given, BlockVector& r) const {
  add_rows(particles_, false, System::particles(x) - u.control_values(), r);
}

void BodyDensities::add_sources(const BlockVector& x, Given given, Sources& to) const {
  const Net w = System::particles(x);
  if (given == Given::included) {
    Net load = Net::Zero(w.rows(), 3);
    rigid_.add_load(load);
    to.add_load(std::move(load));
  }
  if (w.isZero(0)) return;
  set_rows(particles_, true, w, to.density);
  if (rigid_.prescribed()) to.add_load(rigid_.completing_load(w));
}

void BodyDensities::add_residual(const BlockVector& x, const Sources&, const SurfaceVelocity& u, Given given, BlockVector& r) const {
  const Net w = System::particles(x);
  Net known = u.control_values();
  if (given == Given::included) rigid_.add_load_correction(known), rigid_.subtract_prescribed(known);
  Net rows = w - known;
  rigid_.complete(w, rows);
  add_rows(particles_, true, rows, r);
}

void BodyTractions::add_sources(const BlockVector& x, Given, Sources& to) const {
  const Net y = System::particles(x);
  if (y.isZero(0)) return;
  Net load = Net::Zero(y.rows(), 3);
  set_rows(particles_, true, -y, load);
  to.add_load(std::move(load));
}

void BodyTractions::add_residual(const BlockVector& x, const Sources&, const SurfaceVelocity& u, Given, BlockVector& r) const {
  add_rows(particles_, true, u.at_targets(), r);
  if (on_lattice_) add_rows(particles_, true, bodies_.regular(System::particles(x)), r);
}

}  // namespace tanktread::coupling
