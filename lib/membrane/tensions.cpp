#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "membrane/membrane.hpp"
#include "membrane/part.hpp"
#include "surface/patch.hpp"

namespace tanktread::membrane {
namespace {

constexpr double compressed_below = -1e-9;  // of the modulus: a membrane at rest is not compressed by round-off

// Principal tensions, smaller first, from tr(G^-1 g) = l1^2 + l2^2 and det(G^-1 g) = l1^2 l2^2.
std::array<double, 2> tensions_of(const Law& law, double trace, double det) {
  const double middle = trace / 2, spread = std::sqrt(std::max(0., middle * middle - det));
  const auto t = principal_tensions(law, std::sqrt(middle + spread), std::sqrt(det / (middle + spread)));
  return {std::min(t[0], t[1]), std::max(t[0], t[1])};
}

}  // namespace

TensionSummary Membrane::tension_summary(const Net& x) const {
  double smallest = std::numeric_limits<double>::infinity(), area = 0, compressed = 0;
  const double unit = modulus(law_);
  part(all_)->each_batch([&](const Group& group, const Batch& batch, const ReferencePoint* reference, auto...) {
    Pack a[6 * max_order * max_order];
    tangents(group, batch, x, a);
    for (int q = 0; q < group.n_gauss(); ++q)
      for (int l = 0; l < batch.used; ++l) {
        Vec3 a1, a2;
        for (int c = 0; c < 3; ++c) a1[c] = a[6 * q + c][l], a2[c] = a[6 * q + 3 + c][l];
        const ReferencePoint& r = reference[q];
        const double trace = r.g11[l] * a1.dot(a1) + 2 * r.g12[l] * a1.dot(a2) + r.g22[l] * a2.dot(a2);
        const double det = a1.cross(a2).squaredNorm() * r.inverse_det[l];
        const double tension = tensions_of(law_, trace, det)[0] / unit, share = r.area[l] * std::sqrt(det);
        smallest = std::min(smallest, tension);
        area += share;
        if (tension < compressed_below) compressed += share;
      }
  });
  return {smallest, compressed / area};
}

Eigen::MatrixX2d Membrane::tensions(const Net& x, std::span<const spline::Site> sites) const {
  Eigen::MatrixX2d result(sites.size(), 2);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const auto [element, s, t] = sites[i];
    const surface::Jet before = surface::jet(surface::ElementPoints(*space_, unstressed_, element).patch(), s, t);
    const surface::Jet now = surface::jet(surface::ElementPoints(*space_, x, element).patch(), s, t);
    Eigen::Matrix2d r, g;
    r << before.s.dot(before.s), before.s.dot(before.t), before.s.dot(before.t), before.t.dot(before.t);
    g << now.s.dot(now.s), now.s.dot(now.t), now.s.dot(now.t), now.t.dot(now.t);
    const auto tension = tensions_of(law_, r.inverse().cwiseProduct(g).sum(), g.determinant() / r.determinant());
    result.row(i) << tension[0] / modulus(law_), tension[1] / modulus(law_);
  }
  return result;
}

}  // namespace tanktread::membrane
