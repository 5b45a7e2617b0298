#pragma once
// Rotation of each particle since its layer operators were assembled.

#include <span>
#include <vector>

#include "base/types.hpp"
#include "system/particle.hpp"

namespace tanktread::coupling {

/// A layer operator A assembled for the shape x0 serves a later shape x that is x0 rotated and a little deformed: with the rotation Q_p of each
/// particle p that fits its control points best (least squares; Kabsch 1976),
///
///   (A f)_p ~ Q_p sum_q A_pq Q_q^T f_q                                                                                            (4.29)
///
/// This is exact if all particles turn together. Control points of a tank-treading membrane are carried around while the shape stays, which changes
/// the operator by this rotation only.
class Corotation {
 public:
  Corotation() = default;

  /// The rotations that take `from` to `to`, control nets of shape (N, 3). `particles`: the rows of each.
  Corotation(std::span<const Particle> particles, const Net& from, const Net& to);

  Net back(const Net& f) const;    ///< Q^T f
  Net forth(const Net& f) const;  ///< Q f

  /// Returns the displacement to - from less the rigid motion of each particle that fits it best.
  static Net deformation(std::span<const Particle> particles, const Net& from, const Net& to);

 private:
  Net rotated(Net f, bool back) const;

  std::vector<spline::Block> blocks_;
  std::vector<Mat3> rotations_;
};

}  // namespace tanktread::coupling
