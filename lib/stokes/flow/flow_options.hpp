#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/types.hpp"
#include "stokes/flow/flow_history.hpp"
#include "stokes/flow/user_flow.hpp"

namespace tanktread::deck {
class Section;
}

namespace tanktread::stokes {

/// The ambient flow and the outer fluid: `Flow/*` of the deck. The plane of the flow is x1 x3.
struct FlowOptions {
  std::string type = "simple shear";  ///< quiescent, uniform, simple shear, four-roll, planar hyperbolic, uniaxial extension, linear,
                                      ///< parabolic, duct, or a registered one
  double shear_rate = 1.0;            ///< rate of every flow with a gradient but `linear` and `parabolic`, units 1/time
  double viscosity = 1.0;             ///< mu of the outer fluid
  std::optional<double> roll_parameter;  ///< a of (P-48); set for `four-roll`
  std::optional<Mat3> gradient;          ///< L_ij = dv_i/dx_j; set for `linear`
  std::optional<Vec3> velocity;          ///< set for `uniform`
  std::optional<Vec3> gravity;           ///< acceleration, of particles with a density difference
  std::optional<double> mean_velocity;   ///< v_m = Q/(area of the section); set for `duct`
  std::string held = "flow rate";        ///< of `duct`, whatever particles do to it: flow rate, pressure drop
  std::optional<std::string> profile;      ///< round, plane; set for `parabolic`
  std::optional<double> maximum_velocity;  ///< of `parabolic`, at x2 = x3 = 0, units length/time
  std::optional<double> half_width;        ///< of `parabolic`: where the velocity vanishes, units length
  std::optional<FlowHistory> history;      ///< how the flow changes in time; none: not at all
  const UserFlows* registered = nullptr;   ///< further types, with keys in `Flow/<type>`; null: none
  std::shared_ptr<const UserFlow> user;    ///< set for a registered type

  void declare(deck::Section& section);

  /// One sentence (UserError) for keys that contradict each other or are missing.
  void check() const;

  /// The rate of Ca: shear rate, the largest singular value of the gradient of `linear`, maximum velocity over half width of `parabolic`; 0 without a
  /// gradient, and in a duct, which has a speed instead. Of a flow that changes in time that of amplitude 1. Units 1/time.
  double rate() const;

  /// The velocity of Ca = mu speed/G_s: rate times the particle's radius R_C, in a duct the mean velocity. Units length/time.
  double speed(double radius) const;

 private:
  void declare_registered(deck::Section& section);
};

}  // namespace tanktread::stokes
