#pragma once
// Second derivative of a membrane's energy as an assembled matrix, for counting its unstable modes.

#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "membrane/membrane.hpp"

namespace tanktread::membrane {

/// Returns H assembled over all elements. Component c of control point A has row and column 3 A + c.
inline Eigen::SparseMatrix<double> assembled_tangent(const Membrane& membrane, const Net& x) {
  const spline::Space& space = membrane.space();
  std::vector<Eigen::Triplet<double>> entries;
  Tangent tangent(membrane);
  Net u, hu;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    tangent.update(x, std::span(&e, 1));
    for (int b : space.elements[e].points)
      for (int c = 0; c < 3; ++c) {
        u.setZero(space.n_points, 3);
        u(b, c) = 1;
        tangent.apply(u, hu);
        for (int a : space.elements[e].points)
          for (int d = 0; d < 3; ++d) entries.emplace_back(3 * a + d, 3 * b + c, hu(a, d));
      }
  }
  Eigen::SparseMatrix<double> h(3 * space.n_points, 3 * space.n_points);
  h.setFromTriplets(entries.begin(), entries.end());
  return h;
}

}  // namespace tanktread::membrane
