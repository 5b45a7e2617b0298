#include "spline/knots.hpp"

#include "spline/extension.hpp"

namespace tanktread::spline {

namespace {
void reach_along(const TMesh& mesh, Ray ray, int out[2]) {
  const Lattice& l = *mesh.lattice;
  int found = 0;
  for (int distance = 1; found < 2; ++distance) {
    if (l.ends(ray.vertex, ray.slot)) {  // the end knot, repeated
      for (; found < 2; ++found) out[found] = distance - 1;
      return;
    }
    ray = step(l, ray);
    if (l.valence(ray.vertex) == 3) {
      out[found] = distance;
      if (found == 0) out[1] = 2 * distance;
      return;
    }
    if (touches(mesh, ray)) out[found++] = distance;
  }
}
}  // namespace

Knots knots(const TMesh& mesh, int anchor) {
  Knots k{};
  for (int s = 0; s < mesh.lattice->valence(anchor); ++s) reach_along(mesh, {anchor, s}, k.reach[s]);
  return k;
}

std::array<double, 4> b_spline_on(const std::array<double, 5>& k, double a, double b) {
  const double K[11] = {k[0] - 3, k[0] - 2, k[0] - 1, k[0], k[1], k[2], k[3], k[4], k[4] + 1, k[4] + 2, k[4] + 3};
  int span = 3;
  while (span < 6 && K[span + 1] <= a) ++span;
  // De Boor's triangle with a or b in each of its three steps: how many of them are b tells the results of a step apart.
  double d[4][4][4] = {};  // after r steps, n of them with b
  d[0][0][6 - span] = 1;
  for (int r = 1; r <= 3; ++r)
    for (int j = r; j < 4; ++j) {
      const int m = span - 3 + j;
      const double part = 1 / (K[m + 4 - r] - K[m]), x = (a - K[m]) * part, y = (b - K[m]) * part;
      for (int n = 0; n < r; ++n) d[r][n][j] = (1 - x) * d[r - 1][n][j - 1] + x * d[r - 1][n][j];
      d[r][r][j] = (1 - y) * d[r - 1][r - 1][j - 1] + y * d[r - 1][r - 1][j];
    }
  return {d[3][0][3], d[3][1][3], d[3][2][3], d[3][3][3]};
}

}  // namespace tanktread::spline
