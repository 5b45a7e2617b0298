#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

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
  const ElementTensions all = element_tensions(x, all_);
  const auto sum = [](const std::vector<double>& areas) { return std::accumulate(areas.begin(), areas.end(), 0.); };
  return {all.smallest, sum(all.compressed) / sum(all.area)};
}

ElementTensions Membrane::element_tensions(const Net& x, std::span<const int> elements) const {
  const std::vector<double> none(space_->elements.size(), 0.);
  ElementTensions result{std::numeric_limits<double>::infinity(), none, none};
  Pack smallest = Pack{} + result.smallest;
  part(elements)->each_batch([&](const Group& group, const Batch& batch, const ReferencePoint* reference, auto...) {
    Pack a[6 * max_order * max_order], tension[max_order * max_order], share[max_order * max_order], area{}, compressed{};
    const Law& law = materials_.all[group.material].law;
    const double unit = modulus(law);
    tangents(group, batch, x, a);
    smaller_tensions(law, group.n_gauss(), reference, a, tension, share);
    for (int q = 0; q < group.n_gauss(); ++q) {
      smallest = tension[q] / unit < smallest ? tension[q] / unit : smallest;
      area += share[q];
      compressed += tension[q] < compressed_below * unit ? share[q] : Pack{};
    }
    for (int l = 0; l < batch.used; ++l) result.area[batch.elements[l]] = area[l], result.compressed[batch.elements[l]] = compressed[l];
  });
  for (int l = 0; l < lanes; ++l) result.smallest = std::min(result.smallest, smallest[l]);
  return result;
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

}  // namespace tanktread::membrane
