#pragma once

#include <memory>
#include <vector>

#include "base/types.hpp"
#include "stokes/duct_flow.hpp"
#include "stokes/flow_options.hpp"

namespace tanktread::stokes {

/// The flow that would be there without the particle: that of a duct (P-33), or in unbounded space v(x) = v_0 + L x with a constant,
/// trace-free gradient L.
///
///   simple shear         rate (x3, 0, 0)
///   four-roll (P-48)     rate/2 ((1+a) x1 + (1-a) x3, 0, (-1+a) x1 - (1+a) x3)
///   planar hyperbolic    rate (x1, 0, -x3): four-roll with a = 1
///   uniaxial extension   rate (-x1/2, -x2/2, x3)
///   linear               L as given;   uniform   v_0 as given;   quiescent   0
class AmbientFlow {
 public:
  AmbientFlow() = default;  ///< quiescent

  /// `duct`: the flow of the type `duct`, and only of this one.
  explicit AmbientFlow(const FlowOptions& options, std::shared_ptr<const DuctFlow> duct = nullptr);

  /// Velocity at a point, units length/time. Many points at once are much faster in a duct.
  Vec3 velocity(const Vec3& x) const { return duct_ ? duct_->velocity(x) : Vec3(velocity_ + gradient_ * x); }
  Net velocities(const Net& x) const;

  /// L_ij = dv_i/dx_j at a point, units 1/time.
  Mat3 gradient(const Vec3& x) const { return duct_ ? duct_->gradient(x) : gradient_; }
  std::vector<Mat3> gradients(const Net& x) const;

  /// Whether the gradient is the same everywhere.
  bool affine() const { return !duct_; }

  /// The rate of Ca, units 1/time: the shear rate, or the largest singular value of the gradient of `linear`; in a duct the mean velocity over R_T.
  double rate() const { return duct_ ? duct_->mean_velocity() / duct_->radius() : rate_; }

  /// The duct, or nothing.
  const std::shared_ptr<const DuctFlow>& duct() const { return duct_; }

 private:
  std::shared_ptr<const DuctFlow> duct_;
  Vec3 velocity_ = Vec3::Zero();
  Mat3 gradient_ = Mat3::Zero();
  double rate_ = 0;
};

}  // namespace tanktread::stokes
