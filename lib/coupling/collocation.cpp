#include "coupling/collocation.hpp"

#include <vector>

#include "spline/basis.hpp"

namespace tanktread::coupling {

Eigen::SparseMatrix<double> collocation_matrix(const spline::Space& space) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < space.n_points; ++i) {
    const spline::Site& site = space.collocation[static_cast<size_t>(i)].front();
    const spline::Element& element = space.elements[static_cast<size_t>(site.element)];
    const Eigen::VectorXd values = spline::basis(element, site.s, site.t, 0).value;
    for (size_t a = 0; a < element.points.size(); ++a) entries.emplace_back(i, element.points[a], values[static_cast<Eigen::Index>(a)]);
  }
  Eigen::SparseMatrix<double> matrix(space.n_points, space.n_points);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace tanktread::coupling
