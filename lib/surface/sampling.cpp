#include "surface/sampling.hpp"

#include "spline/bernstein.hpp"

namespace tanktread::surface {

/// Sums over s first, then over t.
Grid sample(const Patch& patch) {
  const int p = patch.degree;
  Grid x;
  double at[cells + 1][spline::max_degree + 1];
  for (int i = 0; i <= cells; ++i) spline::bernstein(p, double(i) / cells, at[i]);
  for (int c = 0; c < 3; ++c) {
    double along_s[spline::max_degree + 1][cells + 1];
    for (int j = 0; j <= p; ++j)
      for (int i = 0; i <= cells; ++i) {
        along_s[j][i] = 0;
        for (int k = 0; k <= p; ++k) along_s[j][i] += at[i][k] * patch.coordinate(c, j * (p + 1) + k);
      }
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i) {
        double sum = 0;
        for (int k = 0; k <= p; ++k) sum += at[j][k] * along_s[k][i];
        x[static_cast<size_t>(j)][static_cast<size_t>(i)][c] = sum;
      }
  }
  return x;
}

}  // namespace tanktread::surface
