#include "system/membranes.hpp"

#include <algorithm>
#include <utility>

namespace tanktread::coupling {

Membranes::Membranes(const spline::Space& space, const Net& unstressed, const CapsuleParameters& parameters, const RowShare& layout, Phases& phases)
    : particles_(parameters.particles), layout_(layout), phases_(phases), mass_matrix_(space), mass_(parameters.solvers.direct, parameters.symmetry),
      membrane_(space, unstressed, materials(particles_)), loads_(particles_, layout.elements()), tangent_(membrane_) {
  mass_.factor(mass_matrix_.update(unstressed));
  if (measure() == stokes::Measure::reference) mass_matrix_.release();
  if (std::ranges::any_of(particles_, [](const Particle& one) { return !one.rigid && one.material.viscosity.any(); }))
    viscous_.emplace(membrane_), linearised_viscous_.emplace(membrane_);
}

Net Membranes::work(const Net& x, std::vector<Net>& sums) const {
  Net work(x.rows(), 3);
  membrane_.load(x, layout_.elements(), work);
  sums = complete_work(x, work);
  return work;
}

std::vector<Net> Membranes::complete_work(const Net& x, Net& work) const {
  std::vector<Net> sums = loads_.add_work(x, work);
  layout_.replicate_sums(work);
  for (Net& sum : sums) layout_.replicate_sums(sum);
  loads_.add_global_work(x, sums, work);
  return sums;
}

Net Membranes::load(const Net& x, Net work, Net* other) {
  const bool reference = measure() == stokes::Measure::reference;
  if (other && !reference) *other = solved(std::move(*other));
  const auto clock = phases_.time("projection");
  if (!reference) return mass_.solve(mass_matrix_.update(measured_net(x)), work);
  if (!other) return solved(std::move(work));
  Net* const both[] = {&work, other};
  layout_.solve(mass(), both);
  return work;
}

Net Membranes::strong_load(const Net& x) const {
  Net t = Net::Zero(x.rows(), 3);
  membrane_.strong_load(x, layout_.points(), t);
  layout_.replicate(t);
  return t;
}

Net Membranes::work_of(const membrane::ViscousLoad& c, const Net& v) const {
  const auto clock = phases_.time("membrane");
  Net work;
  c.apply(v, work);
  layout_.replicate_sums(work);
  return work;
}

Net Membranes::viscous_work(const Net& x, const Net& v) {
  if (!same(x, viscous_shape_)) viscous_->update(x, layout_.elements()), viscous_shape_ = x;
  return work_of(*viscous_, v);
}

Net Membranes::viscous_work_change(const Net& v) const { return work_of(*linearised_viscous_, v); }

void Membranes::linearise(const Net& x, const std::vector<Net>& sums) {
  tangent_.update(x, layout_.elements());
  loads_.linearise(x, sums);
  if (viscous_) linearised_viscous_->update(x, layout_.elements());
}

Net Membranes::work_change(const Net& dx) const {
  Net change(dx.rows(), 3);
  tangent_.apply(dx, change);
  loads_.add_tangent(dx, change);
  layout_.replicate_sums(change);
  loads_.add_global_tangent(dx, change);
  clear_rigid(particles_, change);
  return change;
}

}  // namespace tanktread::coupling
