#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/types.hpp"
#include "deck/forward.hpp"
#include "stokes/flow/flow_history.hpp"
#include "stokes/flow/user_flow.hpp"

namespace tanktread::stokes {

/// One plate that bounds a flow, or two parallel plates at a distance.
struct Plates {
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();  ///< point on the first plate; unit normal into the fluid
  std::optional<double> distance;                     ///< distance of the second plate from the first; if not set, there is no second plate
  std::optional<Vec3> velocity, second_velocity;      ///< velocities of the first and the second plate; a plate whose velocity is not set moves with
                                                      ///< the ambient flow
};

/// Options `Flow/*` of the deck: the ambient flow and the outer fluid. The plane of the flow is the x1 x3 plane.
struct FlowOptions {
  std::string type = "simple shear";  ///< quiescent, uniform, simple shear, four-roll, planar hyperbolic, uniaxial extension, linear, parabolic,
                                      ///< duct, or the name of a registered flow
  double shear_rate = 1.0;            ///< rate of simple shear, four-roll, planar hyperbolic and uniaxial extension, units 1/time; 1 for other types
  double viscosity = 1.0;             ///< mu of the outer fluid
  std::optional<double> roll_parameter;  ///< parameter a of the four-roll flow (equation 48 of Maestre et al. 2017, see AmbientFlow); set for
                                         ///< `four-roll`
  std::optional<Mat3> gradient;          ///< velocity gradient L_ij = dv_i/dx_j of the flow type `linear`
  std::optional<Vec3> velocity;          ///< velocity of the flow type `uniform`
  std::optional<Vec3> gravity;           ///< gravitational acceleration, for particles with a density difference
  std::optional<double> mean_velocity;   ///< flow rate divided by the area of the cross-section; set for `duct`, see complete()
  std::optional<double> flow_rate;       ///< flow rate of `duct`, units length^3/time, if the deck gives it instead of the mean velocity
  std::string held = "flow rate";        ///< quantity of `duct` that is held constant when particles disturb the flow: flow rate, pressure drop
  std::optional<std::string> profile;      ///< round (v_1 depends on x2 and x3) or plane (v_1 depends only on x3); set for `parabolic`
  std::optional<double> maximum_velocity;  ///< velocity of `parabolic` at x2 = x3 = 0, units length/time
  std::optional<double> half_width;        ///< distance from the axis or mid-plane at which the velocity of `parabolic` vanishes, length
  std::optional<Vec3> pressure_gradient;   ///< gradient of the mean pressure over a periodic cell with plates or posts, units force/length^3
  std::optional<Plates> plates;            ///< plates, set by the scene; their motion and the pressure gradient change the flow as in (2.48)
  std::optional<FlowHistory> history;      ///< time dependence of the flow; if not set, the flow is steady
  const UserFlows* registered = nullptr;   ///< user-defined types of flow, with keys in `Flow/<type>`; null if there are none
  std::shared_ptr<const UserFlow> user;    ///< set if the type is user-defined

  void declare(deck::Section& section);

  /// Sets the mean velocity if the deck gives the flow rate. `area`: area of the duct's cross-section, in a channel at its inlet.
  void complete(double area) {
    if (flow_rate) mean_velocity = *flow_rate / area;
  }

  std::string choice() const { return "Flow/type `" + type + "`"; }  ///< name of the type for messages

  /// Throws UserError if keys contradict each other or are missing.
  void check() const;
  void reject(Rejections& to) const;  ///< adds to `to` the combinations of keys that are not allowed

  /// Returns the rate that defines the capillary number Ca, units 1/time, at amplitude 1 if the flow changes in time. By type:
  /// - `linear`: largest singular value of the gradient; `parabolic`: maximum velocity divided by the half width;
  /// - `quiescent` between two plates: difference of the plates' velocities divided by the plates' distance; if the velocities do not differ, half
  ///   of the shear rate on the plates due to the pressure gradient;
  /// - `uniform`, and `quiescent` without two plates: 0; `duct`: 0, because Ca is defined with the mean velocity;
  /// - a user-defined type: its own rate; any other type: the shear rate.
  double rate() const;

  /// Returns the velocity that defines Ca = mu speed/G_s: rate times the particle's radius R_C, or in a duct the mean velocity. Units length/time.
  double speed(double radius) const;

 private:
  double rate_between_plates() const;
};

}  // namespace tanktread::stokes
