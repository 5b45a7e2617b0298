#include "stokes/kernels/panel_kernel.hpp"

#include <algorithm>

#include "base/kernel.hpp"

namespace tanktread::stokes {
namespace INSTRUCTIONS {
namespace {

// `Bernstein`: number n_b of Bernstein polynomials, given at compile time for common degrees; 0 if n_b is given at run time by `n_bernstein`.
template <int Bernstein>
void extract_all(int n_bernstein, int functions, const int* points, const double* extraction, const double* net,
                 double* __restrict bezier) {
  const int n_b = Bernstein ? Bernstein : n_bernstein;
  std::fill_n(bezier, 3 * n_b, 0.);
  for (int a = 0; a < functions; ++a) {
    const double* p = net + 3 * static_cast<std::ptrdiff_t>(points[a]);
    const double x = p[0], y = p[1], z = p[2], *row = extraction + n_b * a;
    for (int b = 0; b < n_b; ++b) {
      bezier[b] += row[b] * x;
      bezier[n_b + b] += row[b] * y;
      bezier[2 * n_b + b] += row[b] * z;
    }
  }
}

template <int Nodes>
void combine_all(int n_b, int nodes, const double* table, const double* coefficient, double* __restrict value) {
  const int n = Nodes ? Nodes : nodes;
  std::fill_n(value, n, 0.);
  for (int b = 0; b < n_b; ++b) {
    const double c = coefficient[b], *row = table + n * b;
    for (int k = 0; k < n; ++k) value[k] += row[k] * c;
  }
}

}  // namespace

void extract(int n_b, int functions, const int* points, const double* extraction, const double* net, double* bezier) {
  if (n_b == 16) return extract_all<16>(n_b, functions, points, extraction, net, bezier);
  if (n_b == 25) return extract_all<25>(n_b, functions, points, extraction, net, bezier);
  extract_all<0>(n_b, functions, points, extraction, net, bezier);
}

void combine(int n_b, int n, const double* table, const double* coefficient, double* value) {
  if (n == 9) return combine_all<9>(n_b, n, table, coefficient, value);
  if (n == 16) return combine_all<16>(n_b, n, table, coefficient, value);
  if (n == 25) return combine_all<25>(n_b, n, table, coefficient, value);
  combine_all<0>(n_b, n, table, coefficient, value);
}

void weigh_normals(int n, const double* a, const double* gauss, double* __restrict nx, double* __restrict ny, double* __restrict nz) {
  for (int k = 0; k < n; ++k) {
    nx[k] = gauss[k] * (a[n + k] * a[5 * n + k] - a[2 * n + k] * a[4 * n + k]);
    ny[k] = gauss[k] * (a[2 * n + k] * a[3 * n + k] - a[k] * a[5 * n + k]);
    nz[k] = gauss[k] * (a[k] * a[4 * n + k] - a[n + k] * a[3 * n + k]);
  }
}

void mark_within(int n, const double* x, const double* y, const double* z, const double* reach, const double* target,
                 char* __restrict within) {
  const double tx = target[0], ty = target[1], tz = target[2];
  for (int k = 0; k < n; ++k) {
    const double rx = x[k] - tx, ry = y[k] - ty, rz = z[k] - tz;
    within[k] = rx * rx + ry * ry + rz * rz < reach[k];
  }
}

}  // namespace INSTRUCTIONS

KERNEL(void, extract, (int n_b, int functions, const int* points, const double* extraction, const double* net, double* bezier),
       (n_b, functions, points, extraction, net, bezier))
KERNEL(void, combine, (int n_b, int n, const double* table, const double* coefficient, double* value), (n_b, n, table, coefficient, value))
KERNEL(void, weigh_normals, (int n, const double* tangents, const double* gauss, double* nx, double* ny, double* nz),
       (n, tangents, gauss, nx, ny, nz))
KERNEL(void, mark_within, (int n, const double* x, const double* y, const double* z, const double* reach, const double* target, char* within),
       (n, x, y, z, reach, target, within))

}  // namespace tanktread::stokes
