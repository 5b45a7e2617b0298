#include "stokes/flow/ellipsoid.hpp"

#include <numbers>

#include <Eigen/Geometry>
#include <boost/math/special_functions/ellint_rd.hpp>
#include <boost/math/special_functions/ellint_rf.hpp>

namespace tanktread::stokes {

using std::numbers::pi;

Ellipsoid::Ellipsoid(const Vec3& axes) : semi_axes(axes) {
  const Vec3 s = axes.cwiseAbs2();
  // Carlson's elliptic integrals from 0 to infinity, with Delta = sqrt((x + l)(y + l)(z + l)):
  // R_F(x, y, z) = 1/2 int dl/Delta, R_D(x, y, z) = 3/2 int dl/((z + l) Delta)
  chi = 2 * boost::math::ellint_rf(s[0], s[1], s[2]);
  for (int i = 0; i < 3; ++i) alpha[i] = 2. / 3 * boost::math::ellint_rd(s[(i + 1) % 3], s[(i + 2) % 3], s[i]);
}

Vec3 Ellipsoid::force(double viscosity, const Vec3& velocity) const {
  return 16 * pi * viscosity * velocity.array() / (chi + alpha.array() * semi_axes.array().square());
}

/// Returns the vector w that force_density() uses, w_i = K_i omega_i, with the coefficients K_i given there for a rotation about axis i.
Vec3 Ellipsoid::rotlet(double viscosity, const Vec3& angular_velocity) const {
  const Vec3 s = semi_axes.cwiseAbs2();
  Vec3 k;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, l = (i + 2) % 3;
    k[i] = 16 * pi * viscosity / 3 * angular_velocity[i] / (s[j] * alpha[j] + s[l] * alpha[l]);
  }
  return k;
}

Vec3 Ellipsoid::torque(double viscosity, const Vec3& angular_velocity) const {
  const Vec3 s = semi_axes.cwiseAbs2();
  return (s.sum() - s.array()) * rotlet(viscosity, angular_velocity).array();
}

Vec3 Ellipsoid::force_density(double viscosity, const Vec3& velocity, const Vec3& angular_velocity, const Vec3& x) const {
  const double h = 1 / (x.array() / semi_axes.array().square()).matrix().norm();
  return h / (4 * pi * semi_axes.prod()) * (force(viscosity, velocity) + 3 * rotlet(viscosity, angular_velocity).cross(x));
}

Vec3 Ellipsoid::point(const Vec3& x) const { return x / (x.array() / semi_axes.array()).matrix().norm(); }

Vec3 Ellipsoid::normal(const Vec3& x) const { return (x.array() / semi_axes.array().square()).matrix().normalized(); }

}  // namespace tanktread::stokes
