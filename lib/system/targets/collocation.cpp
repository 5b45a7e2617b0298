#include "system/targets/collocation.hpp"

#include <vector>

#include "quadrature/gauss.hpp"
#include "surface/geometry.hpp"

namespace tanktread::coupling {

BetweenSites between_sites(const spline::Space& space, const Net& surface) {
  const spline::Block all = spline::whole(space);
  return between_sites(space, surface, {&all, 1});
}

BetweenSites between_sites(const spline::Space& space, const Net& surface, std::span<const spline::Block> blocks) {
  stokes::Sites sites;
  std::vector<double> areas;
  for (const spline::Block& block : blocks)
    for (int e = block.first_element; e < block.first_element + block.n_elements; ++e) {
      const quadrature::TensorRule& rule = quadrature::tensor_gauss(space.elements[static_cast<std::size_t>(e)].degree);
      for (int q = 0; q < rule.size(); ++q) {
        const spline::Site site{e, rule.s[q], rule.t[q]};
        sites.push_back({site});
        areas.push_back(rule.weights[q] * surface::point(space, surface, site).jacobian);
      }
    }
  const Eigen::SparseMatrix<double> values = value_matrix(space, sites);
  return {sites, values, values.transpose() * Eigen::Map<const Eigen::VectorXd>(areas.data(), values.rows()).asDiagonal()};
}

Eigen::SparseMatrix<double> value_matrix(const spline::Space& space, const stokes::Sites& sites, Eigen::VectorXd spline::Basis::* which) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const auto& [number, s, t] = sites[i].front();
    const spline::Element& element = space.elements[static_cast<std::size_t>(number)];
    const Eigen::VectorXd values = spline::basis(element, s, t).*which;
    for (std::size_t a = 0; a < element.points.size(); ++a)
      entries.emplace_back(static_cast<int>(i), element.points[a], values[static_cast<Eigen::Index>(a)]);
  }
  Eigen::SparseMatrix<double> matrix(static_cast<Eigen::Index>(sites.size()), space.n_points);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Eigen::SparseMatrix<double> collocation_matrix(const spline::Space& space) { return value_matrix(space, space.collocation); }

}  // namespace tanktread::coupling
