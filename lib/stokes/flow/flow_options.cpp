#include "stokes/flow/flow_options.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "base/rejections.hpp"
#include "base/small_matrices.hpp"
#include "deck/section.hpp"

namespace tanktread::stokes {

namespace {

/// Returns whether the key `shear rate` sets the magnitude of a flow of this type.
bool has_shear_rate(const std::string& type) {
  return type == "simple shear" || type == "four-roll" || type == "planar hyperbolic" || type == "uniaxial extension";
}

/// Returns the values of Flow/type, with the names of registered flows. Throws std::logic_error if a registered flow has the name of another type.
deck::Choice types_of(const UserFlows* registered) {
  deck::Choice types{"quiescent", "uniform", "simple shear", "four-roll", "planar hyperbolic", "uniaxial extension", "linear", "parabolic", "duct"};
  if (!registered) return types;
  for (const std::string& name : registered->names()) {
    if (std::ranges::count(types, name) > 0) throw std::logic_error("a registered flow has the name `" + name + "` of another Flow/type");
    types.push_back(name);
  }
  return types;
}

}  // namespace

void FlowOptions::declare(deck::Section& section) {
  section.key("type", type, types_of(registered),
              "ambient flow, that is the flow without particles; rate means Flow/shear rate. `simple shear`: velocity (rate x3, 0, 0); in "
              "a straight Tube the wall then moves with this velocity. `planar hyperbolic`: velocity (rate x1, 0, -rate x3). `uniaxial "
              "extension`: velocity (-rate x1/2, -rate x2/2, rate x3). `four-roll`: planar flow between extension and rotation, chosen by "
              "Flow/roll parameter. `linear`: any velocity gradient Flow/gradient. `uniform`: constant Flow/velocity. `parabolic`: Poiseuille "
              "profile along x1 in unbounded fluid, with Flow/profile, Flow/maximum velocity and Flow/half width. `duct`: pressure-driven "
              "flow along x1 through a Tube or Channel, with Flow/mean velocity or Flow/flow rate. `quiescent`: fluid at rest");
  section.key("shear rate", shear_rate, deck::positive(), "1/time",
              "shear rate or extension rate of the ambient flow of Flow/type `simple shear`, `planar hyperbolic`, `uniaxial extension` or "
              "`four-roll`. Leave it out for all other types: they have no rate, or other keys define it");
  section.key("viscosity", viscosity, deck::positive(), "stress x time",
              "dynamic viscosity of the outer fluid, which surrounds the particles");
  section.key("roll parameter", roll_parameter, deck::between(-1.0, 1.0), "1",
              "parameter a of Flow/type `four-roll`, whose velocity is r/2 ((1 + a) x1 + (1 - a) x3, 0, (a - 1) x1 - (1 + a) x3) with r = "
              "Flow/shear rate: 1 is planar hyperbolic flow, 0 is simple shear rotated by 45 degrees, -1 is rotation");
  section.key(
      "gradient", gradient, deck::any(), "1/time",
      "velocity gradient dv_i/dx_j of Flow/type `linear`: nine numbers row by row, each row for one component v_i; the trace must be 0");
  section.key("velocity", velocity, deck::any(), "length/time",
              "constant velocity of the ambient flow of Flow/type `uniform`, three numbers");
  section.key("gravity", gravity, deck::any(), "length/time^2",
              "gravitational acceleration, three numbers; no gravity if not given. It acts only on particles that have a "
              "Particle/density difference");
  const bool by_rate = section.given("flow rate");
  refuse(by_rate && section.given("mean velocity"), section.path("flow rate"), section.path("mean velocity"), "both set the same velocity");
  if (type == "duct" && !by_rate) mean_velocity = 1;
  section.key("mean velocity", mean_velocity, deck::positive(), "length/time",
              "mean velocity of Flow/type `duct` in the empty tube or channel: flow rate divided by the area of the cross-section, in a "
              "channel at its inlet; 1 if neither it nor Flow/flow rate is given");
  section.key("flow rate", flow_rate, deck::positive(), "length^3/time",
              "flow rate of Flow/type `duct` through the whole cross-section of the empty tube or channel, instead of Flow/mean velocity: volume "
              "per time, for example `2 ul/min`");
  section.key("held", held, deck::Choice{"flow rate", "pressure drop"},
              "quantity that stays constant in Flow/type `duct` when particles enter: the `flow rate`, or the `pressure drop` between the ends "
              "of the computed part of the duct. It keeps the value that it has in the empty tube or channel");
  if (type == "parabolic") profile = "round", maximum_velocity = 1;
  section.key("pressure gradient", pressure_gradient, deck::any(), "force/length^3",
              "gradient of the mean pressure, three numbers, in a periodic Domain with two plane walls or with posts (fixed cylinders). "
              "The fluid is driven in the opposite direction; zero if not given");
  section.key("profile", profile, deck::Choice{"round", "plane"},
              "velocity profile of Flow/type `parabolic`. `round`: v1 = maximum velocity (1 - (x2^2 + x3^2)/half width^2). `plane`: v1 = "
              "maximum velocity (1 - x3^2/half width^2). `round` if not given");
  section.key("maximum velocity", maximum_velocity, deck::positive(), "length/time",
              "velocity of Flow/type `parabolic` on its axis or mid-plane; 1 if not given");
  section.key("half width", half_width, deck::positive(), "length",
              "distance from the axis or mid-plane at which the velocity of Flow/type `parabolic` vanishes");
  const auto make = registered ? registered->read(section, type, "type") : UserFlows::Maker();
  user = make ? make() : nullptr;
  if (section.given("history") || section.documenting()) {
    history.emplace();
    section.section("history", *history, "time dependence of the ambient flow; the flow is steady without this section");
    if (section.documenting()) history.reset();
  }
}

void FlowOptions::reject(Rejections& to) const {
  const bool driven = pressure_gradient || (plates && (plates->velocity || plates->second_velocity));
  to.pair(history && type == "quiescent" && !driven, "Flow/history",
          {"Flow/type `quiescent`", "Flow/type `quiescent` without a pressure gradient or moving plates"},
          "a fluid at rest has no flow that could vary in time");
  to.pair(history && type == "duct" && history->angles, "Flow/history/angles", "Flow/type `duct`",
          "the flow in a tube or channel cannot be rotated");
}

void FlowOptions::check() const {
  const auto belongs = [this](const char* key, bool given, const char* owner) {
    if (given && type != owner)
      throw UserError(std::string("Flow/") + key + " belongs to Flow/type `" + owner + "`, but Flow/type is `" + type + "`.");
    if (!given && type == owner) throw UserError(std::string("Flow/type `") + owner + "` needs Flow/" + key + ".");
  };
  belongs("roll parameter", roll_parameter.has_value(), "four-roll");
  belongs("gradient", gradient.has_value(), "linear");
  belongs("velocity", velocity.has_value(), "uniform");
  belongs(flow_rate ? "flow rate" : "mean velocity", mean_velocity || flow_rate, "duct");
  belongs("profile", profile.has_value(), "parabolic");
  belongs("maximum velocity", maximum_velocity.has_value(), "parabolic");
  belongs("half width", half_width.has_value(), "parabolic");
  refuse(held != "flow rate" && type != "duct", "Flow/held `" + held + "`", choice(), "it belongs to `duct`");
  refuse(shear_rate != 1.0 && !has_shear_rate(type), "Flow/shear rate", choice(),
         user                  ? "the magnitude of that flow is set by its own keys, in Flow/" + type
         : type == "duct"      ? "give Flow/mean velocity or Flow/flow rate"
         : type == "parabolic" ? "give Flow/maximum velocity"
         : type == "linear"    ? "Flow/gradient already contains its rate"
                               : "that flow has no rate");
  if (history) {
    Rejections found;
    reject(found);
    found.throw_if_any();
    history->check();
  }
  if (gradient && std::abs(gradient->trace()) > 1e-12 * gradient->norm())
    throw UserError("Flow/gradient must have zero trace, because the fluid is incompressible, but its trace is " +
                    formatted("%.3g.", gradient->trace()));
}

double FlowOptions::rate_between_plates() const {
  if (!plates || !plates->distance) return 0.0;
  const double d = *plates->distance;
  const Vec3 apart = plates->second_velocity.value_or(Vec3::Zero()) - plates->velocity.value_or(Vec3::Zero());
  if (!apart.isZero(0)) return apart.norm() / d;
  return pressure_gradient ? pressure_gradient->norm() * d / (4 * viscosity) : 0.0;
}

double FlowOptions::rate() const {
  if (type == "quiescent" || type == "uniform" || type == "duct") return type == "quiescent" ? rate_between_plates() : 0.0;
  if (user) return user->rate();
  if (type == "linear") return largest_stretch(gradient.value());
  if (type == "parabolic") return *maximum_velocity / half_width.value();
  if (!has_shear_rate(type)) throw std::logic_error("no rate is defined for Flow/type " + type);
  return shear_rate;
}

double FlowOptions::speed(double radius) const { return mean_velocity.value_or(rate() * radius); }

}  // namespace tanktread::stokes
