#include "coupling/collocation.hpp"

#include <vector>

#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"
#include "surface/geometry.hpp"

namespace tanktread::coupling {

std::vector<spline::Site> first_sites(const spline::Space& space) {
  std::vector<spline::Site> sites;
  for (const auto& several : space.collocation) sites.push_back(several.front());
  return sites;
}

BetweenSites between_sites(const spline::Space& space, const Net& surface) {
  BetweenSites between;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    const quadrature::TensorRule& rule = quadrature::tensor_gauss(space.elements[static_cast<std::size_t>(e)].degree);
    for (int q = 0; q < rule.size(); ++q) {
      between.places.push_back({e, rule.s[q], rule.t[q]});
      between.areas.push_back(rule.weights[q] * surface::point(space, surface, between.places.back()).jacobian);
    }
  }
  return between;
}

Eigen::SparseMatrix<double> value_matrix(const spline::Space& space, std::span<const spline::Site> places) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const spline::Element& element = space.elements[static_cast<std::size_t>(places[i].element)];
    const Eigen::VectorXd values = spline::basis(element, places[i].s, places[i].t, 0).value;
    for (std::size_t a = 0; a < element.points.size(); ++a)
      entries.emplace_back(static_cast<int>(i), element.points[a], values[static_cast<Eigen::Index>(a)]);
  }
  Eigen::SparseMatrix<double> matrix(static_cast<Eigen::Index>(places.size()), space.n_points);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Eigen::SparseMatrix<double> collocation_matrix(const spline::Space& space) { return value_matrix(space, first_sites(space)); }

}  // namespace tanktread::coupling
