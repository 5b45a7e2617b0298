#include "system/equations/particles.hpp"

namespace tanktread::coupling {

namespace {

/// Returns the rows of the particles that are rigid bodies, or of those that are not, with zeros in all other rows.
Net rows_of(std::span<const Particle> particles, bool rigid, const Net& net) {
  Net rows = Net::Zero(net.rows(), 3);
  for (const Particle& one : particles)
    if (one.rigid.has_value() == rigid) one.block.rows(rows) = one.block.rows(net);
  return rows;
}

}  // namespace

void DeformableVelocities::add_sources(const BlockVector& x, Given given, Sources& to) const {
  const Net v = rows_of(particles_, false, System::particles(x));
  if (has_double_) to.add_density(v);
  if (given == Given::included && load_.size() > 0) to.add_load(load_);
  if (membranes_.viscous() && !v.isZero(0)) to.add_load(membranes_.viscous_load(x_, v));
}

void DeformableVelocities::add_loads_of_work(Sources& to) const { to.add_load(membranes_.load(x_, rows_of(particles_, false, to.work))); }

void DeformableVelocities::add_velocity(const BlockVector& x, Given, Net& v) const { v += rows_of(particles_, false, System::particles(x)); }

void DeformableVelocities::add_residual(const BlockVector& x, const Sources&, const SurfaceVelocity& u, Given, BlockVector& r) const {
  System::particles(r) += rows_of(particles_, false, System::particles(x) - u.control_values());
}

void BodyDensities::add_sources(const BlockVector& x, Given given, Sources& to) const {
  const Net w = System::particles(x);
  to.add_density(rows_of(particles_, true, w));
  Net load = rigid_.prescribed() ? rigid_.completing_load(w) : Net(Net::Zero(w.rows(), 3));
  if (given == Given::included) rigid_.add_load(load);
  if (given == Given::included || rigid_.prescribed()) to.add_load(std::move(load));
}

void BodyDensities::add_loads_of_work(Sources& to) const {
  Net load = Net::Zero(to.work.rows(), 3);
  rigid_.add_load(load, &to.work);
  to.add_load(std::move(load));
}

void BodyDensities::add_velocity(const BlockVector& x, Given given, Net& v) const {
  rigid_.add_velocity(System::particles(x), given == Given::included, v);
}

void BodyDensities::add_residual(const BlockVector& x, const Sources& from, const SurfaceVelocity& u, Given given, BlockVector& r) const {
  const Net w = System::particles(x);
  Net known = u.control_values();
  if (given == Given::included) {
    Net prescribed = Net::Zero(w.rows(), 3);
    rigid_.add_velocity(Net::Zero(w.rows(), 3), true, prescribed);
    rigid_.add_load_correction(known), known -= prescribed;
  }
  if (from.work.size() > 0) rigid_.add_load_correction(known, &from.work);
  Net rows = w - known;
  rigid_.complete(w, rows);
  System::particles(r) += rows_of(particles_, true, rows);
}

void BodyTractions::add_sources(const BlockVector& x, Given, Sources& to) const {
  const Net y = System::particles(x);
  if (!y.isZero(0)) to.add_load(-rows_of(particles_, true, y));
}

void BodyTractions::add_residual(const BlockVector& x, const Sources&, const SurfaceVelocity& u, Given, BlockVector& r) const {
  System::particles(r) += rows_of(particles_, true, u.at_targets());
  if (on_lattice_) System::particles(r) += rows_of(particles_, true, bodies_.regular(System::particles(x)));
}

}  // namespace tanktread::coupling
