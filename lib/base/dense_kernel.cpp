#include "base/dense_factors.hpp"

#include <Eigen/LU>

#include "base/kernel.hpp"

namespace tanktread {
inline namespace INSTRUCTIONS {
namespace {

using Matrix = Eigen::Map<Eigen::MatrixXd>;  // unaligned map, because the alignment that Eigen requires differs between instruction sets

}  // namespace

void factor(int n, double* a, int* row_of) {
  Matrix matrix(a, n, n);
  const Eigen::PartialPivLU<Eigen::Ref<Eigen::MatrixXd>> factors(matrix);
  for (int i = 0; i < n; ++i) row_of[i] = factors.permutationP().indices()[i];
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
