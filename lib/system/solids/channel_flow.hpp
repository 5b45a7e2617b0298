#pragma once
// The flow of an empty channel.

#include <memory>
#include <string>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "stokes/flow/duct_end.hpp"
#include "stokes/flow/duct_flow.hpp"
#include "surface/channel.hpp"
#include "surface/tube_wall.hpp"
#include "system/solids/wall.hpp"

namespace tanktread::coupling {

/// A flow with the flow rate Q through a channel, straight ducts' at its ends, by the wall's own first-kind operator:
///
///   v = -(1/mu) G_W f + dp c + P_I + P_O,   (1/mu) G_W f = dp c + P_I + P_O on the wall,   int v.n dS = Q through a section      (2.30)
///
/// f the traction on the wall, dp the pressure drop between the ends, c (1/mu) of the inlet's integral (2.13), P those of (2.29). The wall is made
/// when a velocity is first asked for, by every rank; Tube uses the same factors. What DuctFlow says beside velocities is said of the inlet.
class ChannelFlow : public stokes::DuctFlow {
 public:
  /// `wall_solver`: as of Wall.
  ChannelFlow(const surface::TubeOptions& options, double viscosity, double mean_velocity, const quadrature::Options& quadrature,
              const std::string& wall_solver = "factored");

  /// Accurate up to the wall; of places that are not inside it means nothing. Those asked for last are kept. Collective.
  Net velocities(const Net& x) const override;

  /// By one-sided differences over a hundredth of the channel's narrowest half width: for Jacobians.
  std::vector<Mat3> gradients(const Net& x) const override;

  double pressure_drop() const;        ///< between the ends
  double extra_pressure_drop() const;  ///< over that of a straight duct of the inlet's section, as long as the centre line
  const Net& wall_traction() const;    ///< f, control values

  /// Flow rates through the sections at s, by sums of velocities, which are evaluated together.
  std::vector<double> flow_rates_at(const std::vector<double>& s) const;

  const surface::Channel& channel() const { return *channel_; }
  const std::shared_ptr<const surface::TubeWall>& surface() const { return surface_; }

  /// The wall's operator, made when it is first asked for; its exchanges count among `phases`, if there are any. Collective.
  std::shared_ptr<Wall> wall(Phases* phases = nullptr) const;

  /// The same, of fields that have the symmetries of a particle inside; from now on every field that is asked for has them, or none.
  std::shared_ptr<Wall> wall(Phases& phases, const surface::Symmetry& particle) const;

 private:
  struct Solved {
    double pressure_drop = 0;
    Net traction;
  };
  const Solved& solved() const;
  Net ends(const Net& x) const;
  quadrature::Options sharper() const;
  Net velocities(const Net& x, const Net& traction, double pressure_drop, bool with_ends) const;
  Net at(const Net& x) const;
  stokes::DuctEnd section(double s, int inward) const;

  std::shared_ptr<const surface::Channel> channel_;
  std::shared_ptr<const surface::TubeWall> surface_;
  surface::TubeOptions options_;
  quadrature::Options quadrature_;
  std::string wall_solver_;
  std::vector<stokes::DuctEnd> ends_;
  mutable std::shared_ptr<stokes::Layer> layer_;  // of the wall, sharper than Wall's: pressures at the ends are large beside the velocity
  mutable std::shared_ptr<Wall> wall_;
  mutable std::shared_ptr<const Solved> solved_;
  mutable Net latest_at_, latest_;
};

}  // namespace tanktread::coupling
