#include "system/equations/volumes.hpp"

#include <utility>

namespace tanktread::coupling {

void VolumeConstraint::project(BlockVector& x) const {
  if (multipliers_) return;
  System::particles(x) = volumes_.applied(System::particles(std::as_const(x)));
}

void VolumeConstraint::add_residual(const BlockVector& x, const Sources&, const SurfaceVelocity&, Given, BlockVector& r) const {
  if (!multipliers_) return;
  Net rows = System::particles(std::as_const(r));
  volumes_.subtract(-x(*multipliers_), rows);
  System::particles(r) = rows;
  r(*multipliers_) += volumes_.multipliers(System::particles(x));
}

void VolumeConstraint::precondition(const BlockVector& r, BlockVector& x) const {
  if (!multipliers_) return;
  Net y = System::particles(std::as_const(x));
  x(*multipliers_) = volumes_.multipliers(y) - r(*multipliers_);
  volumes_.subtract(x(*multipliers_), y);
  System::particles(x) = y;
}

}  // namespace tanktread::coupling
