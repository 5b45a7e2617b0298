#include "surface/patch.hpp"

#include <Eigen/Geometry>

#include "base/indices.hpp"
#include "base/threads.hpp"
#include "spline/bernstein.hpp"

namespace tanktread::surface {

using spline::most_polynomial_degree;

namespace {

/// Values, first and second derivatives of the Bernstein polynomials of degree p at the local coordinates of a point.
struct Factors {
  int p;
  double s[3][most_polynomial_degree + 1], t[3][most_polynomial_degree + 1];
  Factors(int degree, double at_s, double at_t) : p(degree) {
    spline::bernstein(p, at_s, s[0], s[1], s[2]);
    spline::bernstein(p, at_t, t[0], t[1], t[2]);
  }

  /// Returns the value and the derivatives of the coordinate whose Bezier coefficients start at `row`.
  CoordinateJet of(const double* row) const {
    CoordinateJet result{};
    for (int j = 0; j <= p; ++j, row += p + 1) {
      double value = 0, first = 0, second = 0;
      for (int i = 0; i <= p; ++i) {
        value += s[0][i] * row[i];
        first += s[1][i] * row[i];
        second += s[2][i] * row[i];
      }
      result.x += t[0][j] * value;
      result.s += t[0][j] * first;
      result.ss += t[0][j] * second;
      result.t += t[1][j] * value;
      result.st += t[1][j] * first;
      result.tt += t[2][j] * value;
    }
    return result;
  }
};

}  // namespace

Jet jet(const Patch& patch, double s, double t) {
  const Factors factors(patch.degree, s, t);
  Jet result;
  for (int c = 0; c < 3; ++c) {
    const CoordinateJet part = factors.of(patch.points + c * patch.n_bezier());
    result.x[c] = part.x, result.s[c] = part.s, result.t[c] = part.t;
    result.ss[c] = part.ss, result.st[c] = part.st, result.tt[c] = part.tt;
  }
  return result;
}

CoordinateJet jet(const Patch& patch, int c, double s, double t) {
  return Factors(patch.degree, s, t).of(patch.points + c * patch.n_bezier());
}

Vec3 position(const Patch& patch, double s, double t) {
  const int p = patch.degree;
  double b[most_polynomial_degree + 1], c[most_polynomial_degree + 1];
  spline::bernstein(p, s, b);
  spline::bernstein(p, t, c);
  Vec3 result = Vec3::Zero();
  const double* row = patch.points;
  for (int d = 0; d < 3; ++d)
    for (int j = 0; j <= p; ++j, row += p + 1)
      for (int i = 0; i <= p; ++i) result[d] += c[j] * b[i] * row[i];
  return result;
}

double jacobian(const Jet& jet) { return jet.s.cross(jet.t).norm(); }

double mean_curvature(const Jet& jet) {
  const Vec3 n = jet.s.cross(jet.t).normalized();
  const double e = jet.s.dot(jet.s), f = jet.s.dot(jet.t), g = jet.t.dot(jet.t);
  return -(e * jet.tt.dot(n) - 2 * f * jet.st.dot(n) + g * jet.ss.dot(n)) / (2 * (e * g - f * f));
}

namespace {

/// Values of the Bernstein polynomials of each degree at the grid points. Index: degree, polynomial, grid point.
using Tables = std::array<std::array<std::array<double, cells + 1>, most_polynomial_degree + 1>, most_polynomial_degree + 1>;
Tables grid_tables() {
  Tables tables{};
  for (int p = 0; p <= most_polynomial_degree; ++p)
    for (int i = 0; i <= cells; ++i) {
      double values[most_polynomial_degree + 1];
      spline::bernstein(p, double(i) / cells, values);
      for (int k = 0; k <= p; ++k) tables[p][k][i] = values[k];
    }
  return tables;
}

}  // namespace

/// Computes the coordinate on the grid by sums over the Bernstein polynomials in s first, then in t.
Grid<double> sample(const Patch& patch, int c) {
  static const Tables tables = grid_tables();
  const int p = patch.degree;
  const auto& at = tables[p];
  Grid<double> x{};
  const double* coefficient = patch.points + c * patch.n_bezier();
  for (int k = 0; k <= p; ++k) {
    double along_s[cells + 1] = {};
    for (int b = 0; b <= p; ++b, ++coefficient)
      for (int i = 0; i <= cells; ++i) along_s[i] += at[b][i] * *coefficient;
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i) x[j][i] += at[k][j] * along_s[i];
  }
  return x;
}

Grid<Vec3> sample(const Patch& patch) {
  Grid<Vec3> x;
  for (int c = 0; c < 3; ++c) {
    const Grid<double> coordinate = sample(patch, c);
    for (std::size_t j = 0; j <= cells; ++j)
      for (std::size_t i = 0; i <= cells; ++i) x[j][i][c] = coordinate[j][i];
  }
  return x;
}

Patches::Patches(const BezierMap& map, const Net& net) : Patches(map, net, indices(map.n_elements())) {}

Patches::Patches(const BezierMap& map, const Net& net, std::span<const int> elements) {
  std::size_t size = 0;
  for (const int e : elements) size += 3 * map.n_bezier(e);
  points_.resize(size);
  double* next = points_.data();
  for (const int e : elements) {
    patches_.push_back({map.degree(e), next});
    next += 3 * map.n_bezier(e);
  }
  each_block(elements.size(), std::size_t{block_size}, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) map.points(elements[k], net, &points_[static_cast<std::size_t>(patches_[k].points - points_.data())]);
  });
}

}  // namespace tanktread::surface
