#pragma once
// Exact solution for the rigid ellipsoid, to verify the resistance problem.

#include "base/types.hpp"

namespace tanktread::stokes {

/// Rigid ellipsoid in a quiescent fluid, in its principal axes. The semi-axes are a, b, c, and Delta(l) = sqrt((a^2 + l)(b^2 + l)(c^2 + l)):
///
///   chi = int_0^inf dl/Delta,   alpha_i = int_0^inf dl/((a_i^2 + l) Delta)
///
/// Oberbeck 1876, Jeffery 1922; Kim & Karrila 1991, chapter 3. chi: 1/length; alpha_i: 1/length^3.
struct Ellipsoid {
  explicit Ellipsoid(const Vec3& semi_axes);

  /// Returns the force that the body exerts on the fluid when it translates with U: F_i = 16 pi mu U_i / (chi + alpha_i a_i^2).
  Vec3 force(double viscosity, const Vec3& velocity) const;

  /// Returns the torque that the body exerts on the fluid when it rotates with omega:
  /// T_3 = (16 pi mu/3)(a^2 + b^2) omega_3 / (a^2 alpha_1 + b^2 alpha_2), cyclic.
  Vec3 torque(double viscosity, const Vec3& angular_velocity) const;

  /// Returns the force per area that the body exerts on the fluid at a point x of the surface, with h = (sum x_i^2/a_i^4)^(-1/2) = n.x:
  /// f = h/(4 pi abc) (F + 3 w cross x), where w_i = K_i omega_i and K_3 = T_3 / (omega_3 (a^2 + b^2)), cyclic. Jeffery found that the first moment
  /// of the term with w equals the first moment of a uniform stress. The antisymmetric part of this moment is the torque; its symmetric part follows
  /// from the torque by the reciprocal theorem.
  Vec3 force_density(double viscosity, const Vec3& velocity, const Vec3& angular_velocity, const Vec3& x) const;

  /// Returns the point of the surface on the ray from the centre through x.
  Vec3 point(const Vec3& x) const;
  /// Returns the outward unit normal at `point(x)`.
  Vec3 normal(const Vec3& x) const;

  Vec3 semi_axes;
  double chi = 0;
  Vec3 alpha;

 private:
  Vec3 rotlet(double viscosity, const Vec3& angular_velocity) const;
};

}  // namespace tanktread::stokes
