#include "surface/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "base/errors.hpp"
#include "quadrature/gauss.hpp"

namespace tanktread::surface {

namespace {

/// Half of a closed surface of revolution that is symmetric about its equator. A point of the unit sphere at height z maps to a circle about the
/// axis with the radius `equator` times sqrt(1 - z^2), at the height `height(z)`.
struct Meridian {
  double equator;
  std::function<double(double z)> height, slope;  ///< slope: derivative of height with respect to z

  /// Returns int_0^z radius ds with the arc length s of the meridian: the area between the equator and the parallel z, divided by 2 pi.
  double area(double z) const {
    constexpr int panels = 8;
    const quadrature::GaussRule& rule = quadrature::gauss(10);
    double sum = 0;
    for (int k = 0; k < panels * rule.size(); ++k)
      sum += rule.weights[k % rule.size()] * z / panels * density((k / rule.size() + rule.nodes[k % rule.size()]) * z / panels);
    return sum;
  }

  /// Returns the derivative of area(z).
  double density(double z) const {
    const double along = equator * equator * z;
    return std::sqrt(along * along + equator * equator * (1 - z * z) * slope(z) * slope(z));
  }
};

Meridian spheroid(double equator, double pole) {
  return {equator, [pole](double z) { return pole * z; }, [pole](double) { return pole; }};
}

Meridian red_cell_meridian(double radius) {
  const auto half_thickness = [](double z) { return red_cell({std::sqrt(1 - z * z), 0, z})[2]; };
  const auto slope = [](double z) {  // derivative of the height z/2 (c0 + c1 r^2 + c2 r^4) of a red cell with respect to z, with r^2 = 1 - z^2
    const auto [c0, c1, c2] = red_cell_profile;
    const double r2 = 1 - z * z;
    return (c0 + c1 * r2 + c2 * r2 * r2) / 2 - z * z * (c1 + 2 * c2 * r2);
  };
  return {radius, [=](double z) { return radius * half_thickness(z); }, [=](double z) { return radius * slope(z); }};
}

/// Returns the index of the body-fixed axis of revolution of the particle, 2 for x3.
int axis_of(const ParticleShape& shape) {
  if (shape.round()) return 2;
  if (shape.semi_axes) {
    const Vec3& a = *shape.semi_axes;
    for (const int k : {2, 1, 0})
      if (a[(k + 1) % 3] == a[(k + 2) % 3]) return k;
  }
  throw UserError("Membrane/stress-free shape must be `resting` or `file` where Particle/shape has no axis of revolution, as `" + shape.shape +
                  "` here.");
}

Meridian resting_meridian(const ParticleShape& shape, int axis) {
  if (shape.shape == "red cell") return red_cell_meridian(shape.radius.value_or(1));
  if (!shape.ellipsoidal()) throw std::logic_error("no meridian is defined for Particle/shape " + shape.shape);
  const Vec3 semi_axes = shape.semi_axes ? *shape.semi_axes : Vec3::Constant(shape.radius.value_or(1));
  return spheroid(semi_axes[(axis + 1) % 3], semi_axes[axis]);
}

/// Returns the oblate spheroid with this reduced volume and with the surface area 4 pi times `area`.
Meridian spheroid_of(double reduced_volume, double area) {
  const auto of_ratio = [&](double ratio) {
    const Meridian unit = spheroid(1, ratio);
    const double scale = std::sqrt(area / unit.area(1));
    return spheroid(scale, scale * ratio);
  };
  const double volume = reduced_volume * std::pow(4 * std::numbers::pi * area, 1.5) / (6 * std::sqrt(std::numbers::pi));
  double low = 0, high = 1;  // bounds of the ratio of the semi-axes; the volume at fixed area grows with this ratio
  for (int k = 0; k < 60; ++k) {
    const double middle = (low + high) / 2;
    const Meridian one = of_ratio(middle);
    (4 * std::numbers::pi / 3 * std::pow(one.equator, 2) * one.height(1) < volume ? low : high) = middle;
  }
  return of_ratio((low + high) / 2);
}

/// Returns the height z' on the unit sphere with other.area(z') = one.area(z): the parallels z' of `other` and z of `one` enclose equal areas with
/// their equators.
double of_equal_area(const Meridian& one, const Meridian& other, double z) {
  const double sought = one.area(z);
  double found = z;
  for (int k = 0; k < 50; ++k) {
    const double step = (sought - other.area(found)) / other.density(found);
    found = std::clamp(found + step, -1., 1.);
    if (std::abs(step) < 1e-14) break;
  }
  return found;
}

}  // namespace

Net stress_free_spheroid(const LeastSquaresFit& fit, const Net& unit_sphere, const ParticleShape& shape, double reduced_volume) {
  const int axis = axis_of(shape);
  const Meridian resting = resting_meridian(shape, axis), stress_free = spheroid_of(reduced_volume, resting.area(1));
  Net net = fit.fit_image(unit_sphere, [&](const Vec3& x) {
    Vec3 place = x.normalized();
    const double z = place[axis], found = of_equal_area(resting, stress_free, z);
    place[axis] = 0;
    const double radius = place.norm();
    if (radius > 0) place *= stress_free.equator * std::sqrt(1 - found * found) / radius;
    place[axis] = stress_free.height(found);
    return place;
  });
  net = net * shape.rotation().transpose();
  net.rowwise() += shape.center.transpose();
  return net;
}

}  // namespace tanktread::surface
