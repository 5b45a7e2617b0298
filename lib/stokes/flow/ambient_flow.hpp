#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/types.hpp"
#include "stokes/flow/duct_flow.hpp"
#include "stokes/flow/flow_options.hpp"

namespace tanktread::stokes {

/// The flow in the absence of the particle: the flow of a duct (see DuctFlow), or in unbounded space
///
///   v(x) = v_0 + L x + (x.H x) d,   tr L = 0,  H d = 0                                                                   (2.20)
///
///   simple shear         rate (x3, 0, 0)
///   four-roll            rate/2 ((1+a) x1 + (1-a) x3, 0, (-1+a) x1 - (1+a) x3)
///   planar hyperbolic    rate (x1, 0, -x3): four-roll with a = 1
///   uniaxial extension   rate (-x1/2, -x2/2, x3)
///   linear               L as given;   uniform   v_0 as given;   quiescent   0
///   parabolic            maximum velocity (1 - (x2^2 + x3^2)/half width^2, 0, 0), or without x2
///
/// or a registered flow (UserFlow). Between plates at p and p + D n that move with V1 and V2, with a pressure gradient g along them, the flow is
///
///   v + d1 + (d2 - d1) z/D + g z (z - D)/(2 mu),   z = n.(x - p),   d1 = V1 - v, d2 = V2 - v on the plates                (2.48)
///
/// The amplitude of every flow may change in time, and so may its direction, except in a duct (FlowHistory).
class AmbientFlow {
 public:
  AmbientFlow() = default;  ///< quiescent

  /// `duct`: required for the type `duct`, and not permitted for other types.
  explicit AmbientFlow(const FlowOptions& options, std::shared_ptr<const DuctFlow> duct = nullptr);

  /// Sets the time for all later calls, within a step that began at `start` (FlowHistory::at). Returns whether the flow has changed. Before the first
  /// call the flow has the amplitude 1 and is not rotated.
  bool set_time(double time, double start);
  double next_kink(double time) const;  ///< returns the first time after `time` at which the flow is not smooth in time, or infinity

  /// Returns this flow. If its direction changes in time, returns copies of it rotated to several directions instead. A symmetry of all these copies
  /// is a symmetry of the flow in every direction.
  std::vector<AmbientFlow> rotated_copies() const;

  /// Returns the velocity at a point, units length/time. In a duct, evaluating many points at once is much faster.
  Vec3 velocity(const Vec3& x) const;
  Net velocities(const Net& x) const;

  /// Returns L_ij = dv_i/dx_j at a point, units 1/time.
  Mat3 gradient(const Vec3& x) const;
  std::vector<Mat3> gradients(const Net& x) const;

  /// Returns whether the velocity gradient is uniform in space.
  bool affine() const { return !duct_ && steady_.direction.isZero(0) && (!user_ || user_->affine()); }

  /// Returns the mean gradient over a periodic cell, units 1/time: the uniform gradient, or 0 for a flow that is the same in all cells.
  Mat3 cell_gradient() const { return affine() ? gradient(Vec3::Zero()) : Mat3(Mat3::Zero()); }

  /// Returns the matrix F by which the lattice vectors at time 0 are multiplied to get the lattice vectors at `time`: dF/dt = L F, F(0) = I, with L
  /// the gradient `cell_gradient` (2.51).
  Mat3 deformation(double time) const;

  /// Returns d (`direction`) and H (`curvature`) of the quadratic part of the flow (2.20). Both are 0 for an affine flow. They do not include a
  /// registered flow, which need not be quadratic.
  const Vec3& quadratic_direction() const { return field_.direction; }
  const Mat3& curvature() const { return field_.curvature; }

  /// Returns the rate that defines the capillary number, units 1/time: FlowOptions::rate(), or in a duct the mean velocity divided by the radius R_T.
  double rate() const { return duct_ ? duct_->mean_velocity() / duct_->radius() : rate_; }

  double amplitude() const { return moment_.amplitude; }  ///< amplitude at the time set last

  /// Returns whether the amplitude at the time set last is zero up to rounding errors, for example at a zero of a sine.
  bool pauses() const { return std::abs(moment_.amplitude) <= 1e-10; }

  /// Returns the matrix a Q, amplitude times rotation, at the time set last. Velocities of walls and pressure gradients are multiplied by this
  /// matrix.
  Mat3 change() const { return moment_.amplitude * moment_.turn; }

  /// Returns the duct flow; null if this is a flow of another type.
  const std::shared_ptr<const DuctFlow>& duct() const { return duct_; }

 private:
  struct Field {
    Vec3 velocity = Vec3::Zero();
    Mat3 gradient = Mat3::Zero();
    Vec3 direction = Vec3::Zero();
    Mat3 curvature = Mat3::Zero();
  };
  static Field field(const FlowOptions& options);
  static void fit_to_plates(const FlowOptions& options, Field& field);
  AmbientFlow turned(const Mat3& q, double a) const;

  std::shared_ptr<const DuctFlow> duct_;
  std::shared_ptr<const UserFlow> user_;  // user-defined flow, null for built-in types. field_ is added to this flow, and is 0 if there are no plates
  std::optional<FlowHistory> history_;
  Field steady_, field_;  // steady_: field at amplitude 1. field_: field at the current time
  FlowHistory::Moment moment_;
  double rate_ = 0;
};

}  // namespace tanktread::stokes
