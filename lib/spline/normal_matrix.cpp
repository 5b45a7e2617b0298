#include "spline/normal_matrix.hpp"

#include <algorithm>

namespace tanktread::spline {

Eigen::SparseMatrix<double> assemble(int n, const std::vector<LocalMatrix>& local) {
  // Column by column: the elements around an unknown, then a dense accumulator.
  struct Place {
    int element, row;
  };
  std::vector<std::vector<Place>> around(n);
  for (std::size_t k = 0; k < local.size(); ++k)
    if (local[k].values.size() > 0)
      for (std::size_t i = 0; i < local[k].unknowns.size(); ++i) around[local[k].unknowns[i]].push_back({int(k), int(i)});

  Eigen::SparseMatrix<double> out(n, n);
  out.reserve(Eigen::VectorXi::Constant(n, 40));
  std::vector<double> sum(n, 0.0);
  std::vector<char> seen(n, 0);
  std::vector<int> rows;
  for (int j = 0; j < n; ++j) {
    rows.clear();
    for (const Place& p : around[j]) {
      const auto& [unknowns, values] = local[p.element];
      const double* column = values.data() + values.rows() * p.row;
      for (std::size_t i = 0; i < unknowns.size(); ++i) {
        const int r = unknowns[i];
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
