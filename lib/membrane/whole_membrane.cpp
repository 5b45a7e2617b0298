#include "membrane/whole_membrane.hpp"

#include <cmath>
#include <numbers>

#include "base/indices.hpp"

namespace tanktread::membrane {

WholeMembrane::WholeMembrane(const spline::Space& space, const Net& unstressed, double radius, const WholeStiffness& stiffness) {
  Measure area{2, {}}, difference{1, {}};
  area.parts.emplace_back(1.0, Membrane(space, unstressed, SurfaceTension{1}, 4, {}));
  const std::vector<int> all = indices(space.elements.size());
  // of_sphere: int 2 chi dGamma over a sphere of area area0 and radius R, which is 8 pi R (chi: mean curvature).
  const double area0 = area(unstressed, area.gradient_at(unstressed, all)), of_sphere = 4 * std::sqrt(std::numbers::pi * area0);
  area.stiffness = stiffness.area / area0, area.relaxed = area0;
  if (stiffness.leaves > 0) {
    // Computes N = int 2 chi dGamma, with the mean curvature chi, as the difference of two bending energies with spontaneous curvatures -1/R and 1/R
    // (R = `radius`), because (2 chi + 1/R)^2 - (2 chi - 1/R)^2 = 8 chi/R.
    for (const double sign : {-1.0, 1.0})
      difference.parts.emplace_back(-sign, Membrane(space, unstressed, SurfaceTension{0}, 4, {radius / 2, false, sign / radius}));
    difference.stiffness = std::numbers::pi * stiffness.leaves / area0;
    difference.relaxed = stiffness.leaf_difference ? *stiffness.leaf_difference * of_sphere
                                                   : difference(unstressed, difference.gradient_at(unstressed, all));
  }
  for (Measure* const measure : {&area, &difference})
    if (measure->stiffness > 0) measures_.push_back(std::move(*measure));
  for (Measure& measure : measures_)
    for (const auto& part : measure.parts) measure.tangents.emplace_back(part.second);
}

Net WholeMembrane::Measure::gradient_at(const Net& x, std::span<const int> elements) const {
  Net result = Net::Zero(x.rows(), 3), part(x.rows(), 3);
  for (const auto& [factor, membrane] : parts) {
    membrane.load(x, elements, part);
    result += factor * part;
  }
  return result;
}

void WholeMembrane::add_work(const Net& x, std::span<const int> elements, Net& /*work*/, std::span<Net> sums) const {
  for (std::size_t m = 0; m < measures_.size(); ++m) sums[m] += measures_[m].gradient_at(x, elements);
}

void WholeMembrane::add_global_work(const Net& x, std::span<const Net> q, Net& work) const {
  for (std::size_t m = 0; m < measures_.size(); ++m) work += measures_[m].stiffness * (measures_[m](x, q[m]) - measures_[m].relaxed) * q[m];
}

double WholeMembrane::energy(const Net& x, std::span<const Net> q) const {
  double result = 0;
  for (std::size_t m = 0; m < measures_.size(); ++m) result += measures_[m].stiffness * std::pow(measures_[m](x, q[m]) - measures_[m].relaxed, 2) / 2;
  return result;
}

void WholeMembrane::linearise(const Net& x, std::span<const int> elements, std::span<const Net> q) {
  for (std::size_t m = 0; m < measures_.size(); ++m) {
    Measure& measure = measures_[m];
    for (Tangent& tangent : measure.tangents) tangent.update(x, elements);
    measure.tension = measure.stiffness * (measure(x, q[m]) - measure.relaxed);
    measure.q = q[m];
  }
}

void WholeMembrane::add_tangent(const Net& dx, Net& change) const {
  Net turned(dx.rows(), 3);
  for (const Measure& measure : measures_)
    for (std::size_t k = 0; k < measure.parts.size(); ++k) {
      measure.tangents[k].apply(dx, turned);
      change += measure.tension * measure.parts[k].first * turned;
    }
}

void WholeMembrane::add_global_tangent(const Net& dx, Net& change) const {
  for (const Measure& measure : measures_) change += measure.stiffness * measure.q.cwiseProduct(dx).sum() * measure.q;
}

}  // namespace tanktread::membrane
