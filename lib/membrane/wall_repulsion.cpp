#include "membrane/wall_repulsion.hpp"

#include <cmath>
#include <utility>

#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"
#include "surface/geometry.hpp"

namespace tanktread::membrane {

WallRepulsion::WallRepulsion(const spline::Space& space, const Net& unstressed, Repulsion repulsion)
    : space_(space), repulsion_(std::move(repulsion)) {
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    const spline::Element& element = space.elements[static_cast<std::size_t>(e)];
    const quadrature::TensorRule& rule = quadrature::tensor_gauss(quadrature::gauss_order(4, element.degree));  // rule used by Membrane
    auto& value = value_.emplace_back(rule.size(), static_cast<Eigen::Index>(element.points.size()));
    Eigen::VectorXd& area = area_.emplace_back(rule.size());
    for (int q = 0; q < rule.size(); ++q) {
      value.row(q) = spline::basis(element, rule.s[q], rule.t[q]).value.transpose();
      area[q] = rule.weights[q] * surface::point(space, unstressed, {e, rule.s[q], rule.t[q]}).jacobian;
    }
  }
}

/// Returns the Gauss points whose repulsion energy is not negligible.
std::vector<WallRepulsion::RepulsionPoint> WallRepulsion::places(const Net& x, std::span<const int> elements) const {
  // Repulsion at gaps larger than `far` times the range is neglected. The slope of the wall is a central difference quotient of its radius, with the
  // increment `step` times the radius.
  constexpr double far = 40, step = 1e-4;
  std::vector<RepulsionPoint> found;
  for (const int e : elements) {
    const Net at = value_[static_cast<std::size_t>(e)] * Net(x(space_.elements[static_cast<std::size_t>(e)].points, Eigen::all));
    for (int q = 0; q < at.rows(); ++q) {
      const double radius = repulsion_.radius(at(q, 0)), from_axis = std::hypot(at(q, 1), at(q, 2)), gap = radius - from_axis;
      if (gap > far * repulsion_.range) continue;
      const double h = step * radius, slope = (repulsion_.radius(at(q, 0) + h) - repulsion_.radius(at(q, 0) - h)) / (2 * h);
      const double energy = area_[static_cast<std::size_t>(e)][q] * repulsion_.stress * repulsion_.range * std::exp(-gap / repulsion_.range);
      const double divisor = from_axis > 0 ? from_axis : 1;  // on the axis, where the gap has a ridge, its derivatives along x2 and x3 count as 0
      found.push_back({e, q, energy, {slope, -at(q, 1) / divisor, -at(q, 2) / divisor}});
    }
  }
  return found;
}

void WallRepulsion::add_work(const Net& x, std::span<const int> elements, Net& d, std::span<Net> /*sums*/) const {
  for (const RepulsionPoint& at : places(x, elements)) {
    const std::vector<int>& points = space_.elements[static_cast<std::size_t>(at.element)].points;
    for (std::size_t a = 0; a < points.size(); ++a)
      d.row(points[a]) -= row(at)[static_cast<Eigen::Index>(a)] * at.energy / repulsion_.range * at.gradient.transpose();
  }
}

void WallRepulsion::linearise(const Net& x, std::span<const int> elements, std::span<const Net> /*sums*/) { latest_ = places(x, elements); }

void WallRepulsion::add_tangent(const Net& u, Net& hu) const {
  for (const RepulsionPoint& at : latest_) {
    const std::vector<int>& points = space_.elements[static_cast<std::size_t>(at.element)].points;
    double along = 0;
    for (std::size_t a = 0; a < points.size(); ++a) along += row(at)[static_cast<Eigen::Index>(a)] * u.row(points[a]).dot(at.gradient);
    along *= at.energy / (repulsion_.range * repulsion_.range);
    for (std::size_t a = 0; a < points.size(); ++a) hu.row(points[a]) += row(at)[static_cast<Eigen::Index>(a)] * along * at.gradient.transpose();
  }
}

}  // namespace tanktread::membrane
