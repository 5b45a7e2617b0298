#include "spline/normal_matrix.hpp"

#include <algorithm>

namespace tanktread::spline {

Eigen::SparseMatrix<double> assemble(const Space& space, const std::vector<Eigen::MatrixXd>& local) {
  // Column by column: the elements around a point, then a dense accumulator.
  struct Place {
    int element, row;
  };
  std::vector<std::vector<Place>> around(space.n_points);
  for (std::size_t k = 0; k < local.size(); ++k)
    if (local[k].size() > 0)
      for (std::size_t i = 0; i < space.elements[k].points.size(); ++i) around[space.elements[k].points[i]].push_back({int(k), int(i)});

  Eigen::SparseMatrix<double> out(space.n_points, space.n_points);
  out.reserve(Eigen::VectorXi::Constant(space.n_points, 40));
  std::vector<double> sum(space.n_points, 0.0);
  std::vector<char> seen(space.n_points, 0);
  std::vector<int> rows;
  for (int j = 0; j < space.n_points; ++j) {
    rows.clear();
    for (const Place& p : around[j]) {
      const auto& points = space.elements[p.element].points;
      const double* column = local[p.element].data() + local[p.element].rows() * p.row;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const int r = points[i];
        if (r < j) continue;
        if (!seen[r]) {
          seen[r] = 1;
          rows.push_back(r);
        }
        sum[r] += column[i];
      }
    }
    std::sort(rows.begin(), rows.end());
    for (int r : rows) {
      out.insert(r, j) = sum[r];
      sum[r] = 0;
      seen[r] = 0;
    }
  }
  out.makeCompressed();
  return out;
}

}  // namespace tanktread::spline
