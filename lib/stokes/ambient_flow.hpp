#pragma once

#include "base/types.hpp"
#include "stokes/flow_options.hpp"

namespace tanktread::stokes {

/// The flow that would be there without the particle, in unbounded space: v(x) = v_0 + L x with a constant, trace-free gradient L.
///
///   simple shear         rate (x3, 0, 0)
///   four-roll (P-48)     rate/2 ((1+a) x1 + (1-a) x3, 0, (-1+a) x1 - (1+a) x3)
///   planar hyperbolic    rate (x1, 0, -x3): four-roll with a = 1
///   uniaxial extension   rate (-x1/2, -x2/2, x3)
///   linear               L as given;   uniform   v_0 as given;   quiescent   0
class AmbientFlow {
 public:
  AmbientFlow() = default;  ///< quiescent
  explicit AmbientFlow(const FlowOptions& options);

  /// Velocity at a point, units length/time.
  Vec3 velocity(const Vec3& x) const { return velocity_ + gradient_ * x; }

  /// L_ij = dv_i/dx_j at a point, units 1/time.
  const Mat3& gradient(const Vec3& /*x*/) const { return gradient_; }

  /// The rate of Ca, units 1/time: the shear rate, or the largest singular value of the gradient of `linear`.
  double rate() const { return rate_; }

 private:
  Vec3 velocity_ = Vec3::Zero();
  Mat3 gradient_ = Mat3::Zero();
  double rate_ = 0;
};

}  // namespace tanktread::stokes
