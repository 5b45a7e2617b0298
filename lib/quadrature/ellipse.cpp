#include "quadrature/ellipse.hpp"

#include <algorithm>

namespace tanktread::quadrature {
namespace {

/// Returns the parameter rho of the Bernstein ellipse of 1 / |y - a u| as a function of a in [-1, 1]. The function is singular at the complex a =
/// (y.u +- i |y x u|) / u.u.
double rho_along(const Vec3& u, const Vec3& y) {
  const double uu = u.squaredNorm(), re = y.dot(u) / uu;
  return ellipse(re, std::sqrt(std::max(0., y.squaredNorm() / uu - re * re)));
}

}  // namespace

Sight sight(const Patch& patch, const Vec3& target) {
  const Vec3 y = target - patch.centre, &u = patch.u, &v = patch.v;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), yu = y.dot(u), yv = y.dot(v);
  const double determinant = std::max(uu * vv - uv * uv, 1e-12 * uu * vv);
  double a = std::clamp((vv * yu - uv * yv) / determinant, -1., 1.);
  const double b = std::clamp((yv - a * uv) / vv, -1., 1.);
  a = std::clamp((yu - b * uv) / uu, -1., 1.);
  return {(y - a * u - b * v).norm(), rho_along(u, y - b * v), rho_along(v, y - a * u)};
}

}  // namespace tanktread::quadrature
