#pragma once
// Evaluation of a panel at as many quadrature points as fit into a SIMD register; only for use in kernels.

#include "base/register.hpp"
#include "stokes/kernels/point_table.hpp"

namespace tanktread::stokes {
namespace INSTRUCTIONS {

/// Bernstein polynomials at one pack of points (as many as fit into a register) of a PointTable. `Degree`: polynomial degree, given at compile time
/// for common degrees; 0 if the degree is read from the table at run time.
template <int Degree>
struct Points {
  const int n;
  const Register *bs, *bt, *ds, *dt;
  Points(const PointTable& table, int k) : n(Degree ? Degree + 1 : table.degree + 1) {
    bs = registers(table.bernstein.data()) + static_cast<std::ptrdiff_t>(4) * n * k;
    bt = bs + n, ds = bt + n, dt = ds + n;
  }

  Register value(const double* q) const {
    Register total{};
    for (int j = 0; j < n; ++j) {
      Register row{};
      for (int i = 0; i < n; ++i) row += bs[i] * q[n * j + i];
      total += bt[j] * row;
    }
    return total;
  }

  void gradient(const double* q, Register& along_s, Register& along_t) const {
    along_s = along_t = Register{};
    for (int j = 0; j < n; ++j) {
      Register row{}, slope{};
      for (int i = 0; i < n; ++i) row += bs[i] * q[n * j + i], slope += ds[i] * q[n * j + i];
      along_s += bt[j] * slope;
      along_t += dt[j] * row;
    }
  }

  /// Computes r = x - x0 and `normal`, the vector product of the tangents x_,s and x_,t, and returns r.normal. `x`: Bezier points of the panel.
  Register height(const double* x, int n_b, const double* x0, Register (&r)[3], Register (&normal)[3]) const {
    Register a[3], b[3];
    for (int c = 0; c < 3; ++c) {
      r[c] = value(x + n_b * c) - x0[c];
      gradient(x + n_b * c, a[c], b[c]);
    }
    for (int c = 0; c < 3; ++c) normal[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
    return r[0] * normal[0] + r[1] * normal[1] + r[2] * normal[2];
  }
};

/// Returns the number of Bernstein polynomials of a panel. `Degree`: as in Points.
template <int Degree>
int n_bernstein(const PointTable& table) {
  const int n = Degree ? Degree + 1 : table.degree + 1;
  return n * n;
}

/// Computes moment[n_c b + c], the sum of g[n_c k + c] B_b(k) over all points k of a table, for its Bernstein polynomials B_b. g: n_c values per
/// point.
template <int Degree, int n_c>
void project(const PointTable& table, const Register* g, double* moment) {
  const int n = Degree ? Degree + 1 : table.degree + 1;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      Register total[n_c] = {};
      for (int k = 0; k < table.packs(); ++k) {
        const Points<Degree> points(table, k);
        const Register b = points.bs[i] * points.bt[j];
        for (int c = 0; c < n_c; ++c) total[c] += g[n_c * k + c] * b;
      }
      for (int c = 0; c < n_c; ++c) moment[n_c * (n * j + i) + c] = sum(total[c]);
    }
}

/// Calls `use` with an object of Sums<degree> for the common degrees 3 and 4, and otherwise of Sums<0>, which reads the degree at run time.
template <template <int> class Sums, class Use>
void with_degree(int degree, const Use& use) {
  if (degree == 3) return use(Sums<3>());
  if (degree == 4) return use(Sums<4>());
  use(Sums<0>());
}

}  // namespace INSTRUCTIONS
}  // namespace tanktread::stokes
