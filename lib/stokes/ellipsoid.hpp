#pragma once
// The rigid ellipsoid, exactly: what the resistance problem is held against.

#include "base/types.hpp"

namespace tanktread::stokes {

/// An ellipsoid in a fluid at rest, in its principal axes. With Delta(l) = sqrt((a^2 + l)(b^2 + l)(c^2 + l)),
///
///   chi = int_0^inf dl/Delta,   alpha_i = int_0^inf dl/((a_i^2 + l) Delta)
///
/// Oberbeck 1876, Jeffery 1922; Kim & Karrila 1991, chapter 3. chi: 1/length; alpha_i: 1/length^3.
struct Ellipsoid {
  explicit Ellipsoid(const Vec3& semi_axes);

  /// Force that the body exerts on the fluid when it translates with U: F_i = 16 pi mu U_i / (chi + alpha_i a_i^2).
  Vec3 force(double viscosity, const Vec3& velocity) const;

  /// Torque that it exerts when it turns with omega: T_3 = (16 pi mu/3)(a^2 + b^2) omega_3 / (a^2 alpha_1 + b^2 alpha_2), cyclic.
  Vec3 torque(double viscosity, const Vec3& angular_velocity) const;

  /// Force per area that it exerts at a point x of the surface when it translates: f = F h/(4 pi abc), h = (sum x_i^2/a_i^4)^(-1/2).
  Vec3 force_density(double viscosity, const Vec3& velocity, const Vec3& x) const;

  /// Outward unit normal in the direction of x.
  Vec3 normal(const Vec3& x) const;

  Vec3 semi_axes;
  double chi = 0;
  Vec3 alpha;
};

}  // namespace tanktread::stokes
