#include "surface/patch.hpp"

#include <Eigen/Geometry>

#include "base/indices.hpp"
#include "spline/bernstein.hpp"

namespace tanktread::surface {

using spline::max_degree;

Jet jet(const Patch& patch, double s, double t) {
  const int p = patch.degree;
  double b[max_degree + 1], b1[max_degree + 1], b2[max_degree + 1], c[max_degree + 1], c1[max_degree + 1], c2[max_degree + 1];
  spline::bernstein(p, s, b, b1, b2);
  spline::bernstein(p, t, c, c1, c2);
  Jet result{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const double* row = patch.points;
  for (int d = 0; d < 3; ++d) {
    for (int j = 0; j <= p; ++j, row += p + 1) {
      double value = 0, first = 0, second = 0;
      for (int i = 0; i <= p; ++i) {
        value += b[i] * row[i];
        first += b1[i] * row[i];
        second += b2[i] * row[i];
      }
      result.x[d] += c[j] * value;
      result.s[d] += c[j] * first;
      result.ss[d] += c[j] * second;
      result.t[d] += c1[j] * value;
      result.st[d] += c1[j] * first;
      result.tt[d] += c2[j] * value;
    }
  }
  return result;
}

Vec3 place(const Patch& patch, double s, double t) {
  const int p = patch.degree;
  double b[max_degree + 1], c[max_degree + 1];
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

/// Computes the positions on the grid of a patch by sums over the Bernstein polynomials in s first, then in t.
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

Patches::Patches(const BezierMap& map, const Net& net) : Patches(map, net, indices(map.n_elements())) {}

Patches::Patches(const BezierMap& map, const Net& net, std::span<const int> elements) {
  std::size_t size = 0;
  for (const int e : elements) size += 3 * map.n_bezier(e);
  points_.resize(size);
  double* next = points_.data();
  for (const int e : elements) {
    map.points(e, net, next);
    patches_.push_back({map.degree(e), next});
    next += 3 * map.n_bezier(e);
  }
}

}  // namespace tanktread::surface
