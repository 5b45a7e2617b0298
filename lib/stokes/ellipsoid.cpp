#include "stokes/ellipsoid.hpp"

#include <cmath>
#include <numbers>

#include <boost/math/special_functions/ellint_rd.hpp>
#include <boost/math/special_functions/ellint_rf.hpp>

namespace tanktread::stokes {

using std::numbers::pi;

Ellipsoid::Ellipsoid(const Vec3& axes) : semi_axes(axes) {
  const Vec3 s = axes.cwiseAbs2();
  chi = 2 * boost::math::ellint_rf(s[0], s[1], s[2]);  // Carlson's forms: R_F = 1/2 int dl/Delta, R_D = 3/2 int dl/((z + l) Delta)
  for (int i = 0; i < 3; ++i) alpha[i] = 2. / 3 * boost::math::ellint_rd(s[(i + 1) % 3], s[(i + 2) % 3], s[i]);
}

Vec3 Ellipsoid::force(double viscosity, const Vec3& velocity) const {
  return 16 * pi * viscosity * velocity.array() / (chi + alpha.array() * semi_axes.array().square());
}

Vec3 Ellipsoid::torque(double viscosity, const Vec3& angular_velocity) const {
  const Vec3 s = semi_axes.cwiseAbs2();
  Vec3 t;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    t[i] = 16 * pi * viscosity / 3 * (s[j] + s[k]) * angular_velocity[i] / (s[j] * alpha[j] + s[k] * alpha[k]);
  }
  return t;
}

Vec3 Ellipsoid::force_density(double viscosity, const Vec3& velocity, const Vec3& x) const {
  const double h = 1 / std::sqrt((x.array() / semi_axes.array().square()).square().sum());
  return force(viscosity, velocity) * h / (4 * pi * semi_axes.prod());
}

Vec3 Ellipsoid::normal(const Vec3& x) const { return (x.array() / semi_axes.array().square()).matrix().normalized(); }

}  // namespace tanktread::stokes
