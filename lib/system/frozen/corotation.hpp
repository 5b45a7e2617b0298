#pragma once
// Rotations of particles between two shapes, with which operators of the earlier shape are used at the later one.

#include <span>
#include <vector>

#include "base/types.hpp"
#include "system/particle.hpp"

namespace tanktread::coupling {

/// Approximates a layer operator A at a shape x, given A at an earlier shape x0, if x is x0 rotated and slightly deformed. With the rotation Q_p that
/// best maps the control points of particle p from x0 to x (least squares; Kabsch 1976),
///
///   (A f)_p ~ Q_p sum_q A_pq Q_q^T f_q                                                                                            (4.29)
///
/// This is exact if all particles rotate together. If a membrane tank-treads, its control points are convected while the shape is steady, and the
/// operator changes only by this rotation.
class Corotation {
 public:
  Corotation() = default;

  /// Computes, for each particle, the rotation that maps its rows of `from` best to its rows of `to`. Both are control nets of shape (N, 3).
  Corotation(std::span<const Particle> particles, const Net& from, const Net& to);

  Net back(const Net& f) const;    ///< returns Q^T f
  Net forth(const Net& f) const;  ///< returns Q f

  /// Returns the displacement `to` - `from` minus the best-fitting rigid motion of each particle.
  static Net deformation(std::span<const Particle> particles, const Net& from, const Net& to);

 private:
  Net rotated(Net f, bool back) const;

  std::vector<spline::Block> blocks_;
  std::vector<Mat3> rotations_;
};

}  // namespace tanktread::coupling
