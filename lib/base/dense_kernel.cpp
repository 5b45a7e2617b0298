#include "base/dense_factors.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "base/indices.hpp"
#include "base/kernel.hpp"
#include "base/stop.hpp"
#include "base/threads.hpp"

namespace tanktread {
inline namespace INSTRUCTIONS {
namespace {

using Matrix = Eigen::Map<Eigen::MatrixXd>;  // unaligned map, because the alignment that Eigen requires differs between instruction sets

/// Factors `panel`, the columns from `first` on of the rows from `first` on of `all`. Swaps complete rows of `all` and their indices `order`.
void factor_panel(Matrix& all, Eigen::Block<Matrix> panel, int first, int* order) {
  const Eigen::Index rows = panel.rows(), columns = panel.cols();
  for (Eigen::Index j = 0; j < columns; ++j) {
    Eigen::Index pivot = 0;
    panel.col(j).tail(rows - j).cwiseAbs().maxCoeff(&pivot);
    if (pivot > 0) {
      all.row(first + j).swap(all.row(first + j + pivot));
      std::swap(order[first + j], order[first + j + pivot]);
    }
    const Eigen::Index below = rows - j - 1, right = columns - j - 1;
    if (panel(j, j) != 0) panel.col(j).tail(below) /= panel(j, j);
    panel.bottomRightCorner(below, right).noalias() -= panel.col(j).tail(below) * panel.row(j).tail(right);
  }
}

}  // namespace

void factor(int n, double* a, int* row_of) {
  constexpr int columns_at_a_time = 128, width = 64;  // the product for one panel takes about a second for n = 10,000
  Matrix all(a, n, n);
  std::vector<int> order = indices(n);
  for (int first = 0; first < n; first += width) {
    stop_here();
    const int columns = std::min(width, n - first), rest = n - first - columns;
    factor_panel(all, all.block(first, first, n - first, columns), first, order.data());
    each_block(rest, columns_at_a_time, [&](int from, int to) {
      auto right = all.block(first, first + columns + from, columns, to - from);
      all.block(first, first, columns, columns).triangularView<Eigen::UnitLower>().solveInPlace(right);
      all.block(first + columns, first + columns + from, rest, to - from).noalias() -= all.block(first + columns, first, rest, columns) * right;
    });
  }
  for (int i = 0; i < n; ++i) row_of[order[static_cast<std::size_t>(i)]] = i;
}

void solve_triangles(int n, const double* factors, int columns, double* x) {
  const Eigen::Map<const Eigen::MatrixXd> lu(factors, n, n);
  const auto solve = [&](auto all) {
    lu.triangularView<Eigen::UnitLower>().solveInPlace(all);
    lu.triangularView<Eigen::Upper>().solveInPlace(all);
  };
  columns == 1 ? solve(Eigen::Map<Eigen::VectorXd>(x, n)) : solve(Matrix(x, n, columns));  // a single column is solved as a vector, without packing
}

}  // namespace INSTRUCTIONS

KERNEL(void, factor, (int n, double* a, int* row_of), (n, a, row_of))
KERNEL(void, solve_triangles, (int n, const double* factors, int columns, double* x), (n, factors, columns, x))

}  // namespace tanktread
