#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/types.hpp"
#include "stokes/flow/duct_flow.hpp"
#include "stokes/flow/flow_options.hpp"

namespace tanktread::stokes {

/// The flow that would be there without the particle: that of a duct (P-33), or in unbounded space
///
///   v(x) = v_0 + L x + (x.H x) d,   tr L = 0,  H d = 0                                                                   (2.20)
///
///   simple shear         rate (x3, 0, 0)
///   four-roll (P-48)     rate/2 ((1+a) x1 + (1-a) x3, 0, (-1+a) x1 - (1+a) x3)
///   planar hyperbolic    rate (x1, 0, -x3): four-roll with a = 1
///   uniaxial extension   rate (-x1/2, -x2/2, x3)
///   linear               L as given;   uniform   v_0 as given;   quiescent   0
///   parabolic            maximum velocity (1 - (x2^2 + x3^2)/half width^2, 0, 0), or without x2
///
/// or a registered one (UserFlow), or any of them with an amplitude, and but for the duct a direction, that change in time (FlowHistory).
class AmbientFlow {
 public:
  AmbientFlow() = default;  ///< quiescent

  /// `duct`: the flow of the type `duct`, and only of this one.
  explicit AmbientFlow(const FlowOptions& options, std::shared_ptr<const DuctFlow> duct = nullptr);

  /// The time of all that follows, in a step that began at `start` (FlowHistory::at); whether the flow is another one now. Before the first call
  /// it is the one of amplitude 1, not turned.
  bool at(double time, double start);
  double next_kink(double time) const;  ///< the first time after this one at which the flow is not smooth, or infinity

  /// This flow; where its direction changes in time, also others, which have no symmetry in common but that of all directions.
  std::vector<AmbientFlow> directions() const;

  /// Velocity at a point, units length/time. Many points at once are much faster in a duct.
  Vec3 velocity(const Vec3& x) const;
  Net velocities(const Net& x) const;

  /// L_ij = dv_i/dx_j at a point, units 1/time.
  Mat3 gradient(const Vec3& x) const;
  std::vector<Mat3> gradients(const Net& x) const;

  /// Whether the gradient is the same everywhere.
  bool affine() const { return user_ ? user_->affine() : !duct_ && steady_.direction.isZero(0); }

  /// The quadratic part of (2.20): d and H, both 0 of an affine flow, and of a registered one, which need not be quadratic.
  const Vec3& direction() const { return field_.direction; }
  const Mat3& curvature() const { return field_.curvature; }

  /// The rate of Ca, units 1/time: that of the options; in a duct the mean velocity over R_T.
  double rate() const { return duct_ ? duct_->mean_velocity() / duct_->radius() : rate_; }

  double amplitude() const { return moment_.amplitude; }  ///< at the time told last

  /// The duct, or nothing.
  const std::shared_ptr<const DuctFlow>& duct() const { return duct_; }

 private:
  struct Field {
    Vec3 velocity = Vec3::Zero();
    Mat3 gradient = Mat3::Zero();
    Vec3 direction = Vec3::Zero();
    Mat3 curvature = Mat3::Zero();
  };
  static Field field(const FlowOptions& options);
  AmbientFlow turned(const Mat3& q, double a) const;

  std::shared_ptr<const DuctFlow> duct_;
  std::shared_ptr<const UserFlow> user_;  // in place of the field
  std::optional<FlowHistory> history_;
  Field steady_, field_;  // at amplitude 1, and now
  FlowHistory::Moment moment_;
  double rate_ = 0;
};

}  // namespace tanktread::stokes
