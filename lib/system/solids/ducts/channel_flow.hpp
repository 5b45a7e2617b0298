#pragma once
// The flow in an empty channel.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "stokes/flow/duct_end.hpp"
#include "stokes/flow/duct_flow.hpp"
#include "stokes/layer.hpp"
#include "surface/walls/channel.hpp"
#include "surface/walls/tube_wall.hpp"
#include "system/solids/ducts/wall.hpp"

namespace tanktread::coupling {

struct SharedWalls;

/// Flow (2.30) through an empty channel. All values are proportional to `strength`, except `driving` in an open channel.
struct EmptyFlow {
  double strength = 1;       ///< viscosity times flow rate
  double pressure_drop = 0;
  double driving = 1;        ///< factor of ChannelFlow::driving_velocity()
  Net traction;              ///< control values of f
};

/// Data that ChannelFlow computes once per wall.
struct EmptyChannel {
  stokes::Layer layer;            ///< single layer of the wall at points off the wall, with a smaller tolerance than Wall::layer
  std::optional<EmptyFlow> flow;  ///< the flow that was solved first
};

/// Flow through a channel with the flow rate Q. At each end the flow is fully developed, as in a straight duct. The velocity v follows from an
/// equation of the first kind for the wall traction f:
///
///   v = -(1/mu) G_W f + dp c + P_I + P_O,   (1/mu) G_W f = dp c + P_I + P_O on the wall,   int v.n dS = Q through a cross-section (2.30)
///
/// G_W is the single layer of the wall, dp the pressure drop between the ends, and c the velocity due to a unit pressure at the inlet: 1/mu times
/// (2.13). P_I and P_O are the velocities (2.29) due to the duct flow through the inlet and the outlet. The wall operator is constructed by all ranks
/// when a velocity is first needed; Tube uses the same LU factors. All members of DuctFlow except velocities and gradients refer to the duct at the
/// inlet.
///
/// In a periodic channel of period L, Poiseuille flow in a circular tube with the pressure gradient dp/L replaces the terms dp c, P_I and P_O. Then f
/// is the traction of the fluid inside minus the traction of a fictitious fluid outside, whose velocity also vanishes on the wall.
class ChannelFlow : public stokes::DuctFlow {
 public:
  /// `walls`: walls of the run; the channel uses a wall of this set, or builds its wall if the pointer is null.
  ChannelFlow(const surface::TubeOptions& options, double viscosity, double mean_velocity, const quadrature::Options& quadrature,
              const WallSolver& solver = {}, std::shared_ptr<SharedWalls> walls = {});

  /// Returns the velocities at x, accurate up to the wall. At points outside the channel the values are undefined. The values at the latest points x
  /// are cached. Collective.
  Net velocities(const Net& x) const override;

  /// Computes the velocity gradients by one-sided differences with a step of a hundredth of the channel's smallest half width. Their accuracy
  /// suffices only for Jacobians.
  std::vector<Mat3> gradients(const Net& x) const override;

  double pressure_drop() const;  ///< pressure drop between the ends
  double pressure_drop(double /*length*/) const override { return pressure_drop(); }
  double extra_pressure_drop() const override;  ///< extra_pressure_drop of DuctFlow; the straight duct is as long as the centre line
  const Net& wall_traction() const;    ///< control values of f: the traction on the wall, but in a periodic channel only a density that gives v_inf

  /// Returns the flow rates through the cross-sections at the arc lengths s of the centre line. All velocities for them are evaluated in one call.
  std::vector<double> flow_rates_at(const std::vector<double>& s) const;

  const surface::Channel& channel() const { return *channel_; }
  std::shared_ptr<const surface::TubeWall> fixed_wall() const override { return surface_; }

  /// Returns the wall operator, which is constructed at the first call. If `phases` is given at the first call, it records the time of the operator's
  /// communication between ranks. Collective.
  std::shared_ptr<Wall> wall(Phases* phases = nullptr) const;

  /// Replaces the wall operator by the operator for fields with the symmetries of the particle in the channel, and returns it. From then on, all
  /// fields must have these symmetries. The empty flow has all symmetries of the channel, so that a solution found before remains valid. Collective.
  std::shared_ptr<Wall> use_symmetry(Phases& phases, const surface::Symmetry& particle) const;

 private:
  EmptyChannel& kept() const;
  const EmptyFlow& solved() const;
  EmptyFlow solution(const Wall& wall) const;
  Net driving_velocity(const Net& x) const;
  Net velocities(const Net& x, const Net& traction, double pressure_drop, double driving) const;
  Net evaluated(const Net& x) const;  // velocities at x, not cached
  stokes::DuctEnd section(double s, int inward) const;

  std::shared_ptr<const surface::Channel> channel_;
  std::shared_ptr<const surface::TubeWall> surface_;
  surface::TubeOptions options_;
  quadrature::Options quadrature_;
  WallSolver solver_;
  std::shared_ptr<SharedWalls> walls_;
  std::vector<stokes::DuctEnd> ends_;
  mutable std::shared_ptr<Wall> wall_;
  mutable std::optional<EmptyFlow> solved_;  // the flow of EmptyChannel scaled to the viscosity and flow rate of this channel
  mutable Net latest_at_, latest_;
};

}  // namespace tanktread::coupling
