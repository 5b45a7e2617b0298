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
  std::array<double, 4> out;
  for (int i = 0; i < 4; ++i) {
    double d[4];
    for (int j = 0; j < 4; ++j) d[j] = span - 3 + j == 3;
    for (int r = 1; r <= 3; ++r) {
      const double u = r <= 3 - i ? a : b;
      for (int j = 3; j >= r; --j) {
        const int m = span - 3 + j;
        const double x = (u - K[m]) / (K[m + 4 - r] - K[m]);
        d[j] = (1 - x) * d[j - 1] + x * d[j];
      }
    }
    out[i] = d[3];
  }
  return out;
}

}  // namespace tanktread::spline
