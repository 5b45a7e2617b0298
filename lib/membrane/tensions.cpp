#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "membrane/membrane.hpp"
#include "membrane/part.hpp"
#include "surface/patch.hpp"

namespace tanktread::membrane {
namespace {

constexpr double compressed_below = -1e-9;  // of the modulus: a membrane at rest is not compressed by round-off

struct Metric {
  double s, st, t;  // covariant components
};

// Principal tensions, smaller first. The stretch tensor in the orthonormal frame that starts with X_,s: so written, equal stretches stay
// equal to round-off.
std::array<double, 2> tensions_of(const Law& law, const Metric& before, const Metric& now) {
  const double det = before.s * before.t - before.st * before.st, turn = before.st / before.s;
  const double h11 = now.s / before.s, h12 = (now.st - turn * now.s) / std::sqrt(det);
  const double h22 = (now.t - 2 * turn * now.st + turn * turn * now.s) * before.s / det;
  const double middle = (h11 + h22) / 2, spread = std::hypot((h11 - h22) / 2, h12), larger = middle + spread;
  const auto t = principal_tensions(law, std::sqrt(larger), std::sqrt((h11 * h22 - h12 * h12) / larger));
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
        const double det = 1 / r.inverse_det[l];
        const Metric before{r.g22[l] * det, -r.g12[l] * det, r.g11[l] * det}, now{a1.dot(a1), a1.dot(a2), a2.dot(a2)};
        const double tension = tensions_of(law_, before, now)[0] / unit;
        const double share = r.area[l] * a1.cross(a2).norm() * std::sqrt(r.inverse_det[l]);
        smallest = std::min(smallest, tension);
        area += share;
        if (tension < compressed_below) compressed += share;
      }
  });
  return {smallest, compressed / area};
}

Eigen::MatrixX2d tensions(const Law& law, std::span<const surface::Jet> unstressed, std::span<const surface::Jet> now) {
  const auto metric = [](const surface::Jet& a) { return Metric{a.s.dot(a.s), a.s.dot(a.t), a.t.dot(a.t)}; };
  const double unit = modulus(law);
  Eigen::MatrixX2d result(now.size(), 2);
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto tension = tensions_of(law, metric(unstressed[i]), metric(now[i]));
    result.row(i) << tension[0] / unit, tension[1] / unit;
  }
  return result;
}

Eigen::MatrixX2d Membrane::tensions(const Net& x, std::span<const spline::Site> sites) const {
  std::vector<surface::Jet> before, now;
  for (const auto& [element, s, t] : sites) {
    before.push_back(surface::jet(surface::ElementPoints(*space_, unstressed_, element).patch(), s, t));
    now.push_back(surface::jet(surface::ElementPoints(*space_, x, element).patch(), s, t));
  }
  return membrane::tensions(law_, before, now);
}

}  // namespace tanktread::membrane
