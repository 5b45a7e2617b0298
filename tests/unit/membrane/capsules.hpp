#pragma once
// Spheres and smoothly deformed capsules for the tests of the membrane module.

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <variant>
#include <vector>

#include "base/types.hpp"
#include "membrane/membrane.hpp"
#include "spline/extraction.hpp"
#include "surface/shapes.hpp"
#include "tests/membrane_totals.hpp"

namespace tanktread::membrane {

/// Returns the strain energy Psi per unstressed area at the principal stretches l1 and l2.
inline double energy(const Law& law, double l1, double l2) {
  return std::visit([&](const auto& l) { return l.energy(l1 * l1 + l2 * l2 - 2, l1 * l1 * l2 * l2 - 1); }, law);
}

/// A unit sphere on the cube mesh of n x n elements per face. Spheres are cached, because fits take time.
struct Sphere {
  spline::Space space;
  Net net;
  std::vector<int> elements;  ///< indices of all elements
};

inline const Sphere& sphere(int n) {
  static std::map<int, Sphere> kept;
  const auto found = kept.find(n);
  if (found != kept.end()) return found->second;
  Sphere& made = kept[n];
  const spline::TMesh mesh = spline::cube(n);
  made.space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  made.net = surface::unit_sphere(mesh, surface::LeastSquaresFit(made.space));
  made.elements.resize(made.space.elements.size());
  std::iota(made.elements.begin(), made.elements.end(), 0);
  return made;
}

/// Returns a smooth, strongly stretched, bent and sheared image of a net, without any symmetry.
inline Net deformed(const Net& net) {
  Net out = net;
  for (Eigen::Index i = 0; i < net.rows(); ++i) {
    const double x = net(i, 0), y = net(i, 1), z = net(i, 2);
    out.row(i) << 1.3 * x + 0.4 * z + 0.1 * y * y, 0.85 * y + 0.1 * std::sin(2 * x), 0.9 * z + 0.15 * x * y + 0.05 * std::cos(2 * z);
  }
  return out;
}

inline Net random_net(Eigen::Index n, unsigned seed) {
  std::mt19937 generator(seed);
  Net net(n, 3);
  for (Eigen::Index i = 0; i < net.size(); ++i) net.data()[i] = 2.0 * generator() / std::mt19937::max() - 1;
  return net;
}

inline double inner(const Net& a, const Net& b) { return a.cwiseProduct(b).sum(); }

/// Returns df/dx u by a central difference of fourth order, with truncation and round-off errors near 1e-11.
template <class F>
std::invoke_result_t<F, Net> difference(const F& f, const Net& x, const Net& u) {
  const double h = 1e-4;
  return (8 * (f(x + h * u) - f(x - h * u)) - (f(x + 2 * h * u) - f(x - 2 * h * u))) / (12 * h);
}

/// Returns the difference between the response of a law at I1, I2 and central differences of its energy and of itself. Truncation error 1e-10,
/// round-off 1e-11.
template <class L>
double response_error(const L& law, double i1, double i2) {
  const double h = 1e-5;
  const auto at = [&](double a, double b) { return law.response(i1 + a * h, i2 + b * h); };
  const auto r = at(0, 0);
  return std::max({std::abs(r.psi1 - (law.energy(i1 + h, i2) - law.energy(i1 - h, i2)) / (2 * h)),
                   std::abs(r.psi2 - (law.energy(i1, i2 + h) - law.energy(i1, i2 - h)) / (2 * h)),
                   std::abs(r.psi11 - (at(1, 0).psi1 - at(-1, 0).psi1) / (2 * h)),
                   std::abs(r.psi12 - (at(0, 1).psi1 - at(0, -1).psi1) / (2 * h)),
                   std::abs(r.psi22 - (at(0, 1).psi2 - at(0, -1).psi2) / (2 * h))});
}

/// Returns the relative difference between the load along a direction and the gradient of the energy. The direction is u plus the load scaled
/// to the norm of u, because the change of the energy along u alone may be so small that round-off of the energy hides it.
inline double gradient_error(const Membrane& membrane, const Net& x, const Net& u) {
  const Net load = membrane.load(x), along = u + u.norm() / load.norm() * load;
  return std::abs(inner(load, along) / difference([&](const Net& y) { return energy(membrane, y); }, x, along) - 1);
}

/// Returns the relative difference between the tangent applied to u and the gradient of the load.
inline double tangent_error(const Membrane& membrane, const Sphere& s, const Net& x, const Net& u) {
  Tangent tangent(membrane);
  tangent.update(x, s.elements);
  Net hu;
  tangent.apply(u, hu);
  const Net expected = difference([&](const Net& y) { return membrane.load(y); }, x, u);
  return (hu - expected).norm() / expected.norm();
}

}  // namespace tanktread::membrane
