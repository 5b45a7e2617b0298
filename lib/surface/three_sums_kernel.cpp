#include "surface/three_sums.hpp"

#include "base/kernel.hpp"

namespace tanktread::surface {
namespace INSTRUCTIONS {
namespace {

/// Computes columns first .. first + width - 1 of the result of three_sums().
template <int width>
void add_columns(int first, int n, int n_rows, const double* rows, const double* factors, double* out) {
  constexpr int registers = width / lanes;
  Register sum[3][registers] = {};
  for (int r = 0; r < n_rows; ++r)
    for (int k = 0; k < registers; ++k) {
      const Register row = load(rows + n * r + first + lanes * k);
      for (int c = 0; c < 3; ++c) sum[c][k] += factors[n_rows * c + r] * row;
    }
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < registers; ++k) store(sum[c][k], out + n * c + first + lanes * k);
}

/// Computes column k of the result of three_sums(). Used for the columns that do not fill a SIMD register.
void add_column(int k, int n, int n_rows, const double* rows, const double* factors, double* out) {
  for (int c = 0; c < 3; ++c) {
    double sum = 0;
    for (int r = 0; r < n_rows; ++r) sum += factors[n_rows * c + r] * rows[n * r + k];
    out[n * c + k] = sum;
  }
}

}  // namespace

void three_sums(int n, int n_rows, const double* rows, const double* factors, double* out) {
  constexpr int width = lanes < 4 ? 4 * lanes : 16;
  int k = 0;
  for (; k + width <= n; k += width) add_columns<width>(k, n, n_rows, rows, factors, out);
  for (; k + lanes <= n; k += lanes) add_columns<lanes>(k, n, n_rows, rows, factors, out);
  for (; k < n; ++k) add_column(k, n, n_rows, rows, factors, out);
}

}  // namespace INSTRUCTIONS

KERNEL(void, three_sums, (int n, int n_rows, const double* rows, const double* factors, double* out), (n, n_rows, rows, factors, out))

}  // namespace tanktread::surface
