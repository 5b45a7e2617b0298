#pragma once
// The innermost loop between control points, Bezier points and places on an element.

#include <algorithm>

namespace tanktread::surface {

/// Eight numbers side by side, anywhere in memory.
using Eight [[gnu::vector_size(8 * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] = double;

/// As below, of a length that the compiler knows.
template <int n, class Factor>
void three_sums(int n_rows, const double* rows, const Factor& factor, double* out) {
  constexpr int wide = n / 8, rest = n % 8;
  Eight sum[3][wide] = {};
  double tail[3][rest + 1] = {};
  for (int r = 0; r < n_rows; ++r, rows += n)
    for (int c = 0; c < 3; ++c) {
      const double f = factor(r, c);
      for (int k = 0; k < wide; ++k) sum[c][k] += f * reinterpret_cast<const Eight*>(rows)[k];
      for (int k = 0; k < rest; ++k) tail[c][k] += f * rows[8 * wide + k];
    }
  for (int c = 0; c < 3; ++c, out += n) {
    for (int k = 0; k < wide; ++k) reinterpret_cast<Eight*>(out)[k] = sum[c][k];
    std::copy_n(tail[c], rest, out + 8 * wide);
  }
}

/// Three sums of rows of n numbers, out[c n + k] = sum_r factor(r, c) rows[r n + k], always in the order of the rows.
template <class Factor>
void three_sums(int n, int n_rows, const double* rows, const Factor& factor, double* out) {
  if (n == 16) return three_sums<16>(n_rows, rows, factor, out);  // a bicubic element
  if (n == 25) return three_sums<25>(n_rows, rows, factor, out);
  std::fill_n(out, 3 * n, 0.);
  for (int r = 0; r < n_rows; ++r)
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < n; ++k) out[c * n + k] += factor(r, c) * rows[r * n + k];
}

}  // namespace tanktread::surface
