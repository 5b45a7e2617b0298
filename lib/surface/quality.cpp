#include "surface/quality.hpp"

#include <algorithm>
#include <vector>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "base/indices.hpp"
#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"
#include "surface/patch.hpp"
#include "surface/three_sums.hpp"

namespace tanktread::surface {
namespace {

constexpr int points = 16;  ///< 4 x 4
constexpr int most = (spline::max_degree + 1) * (spline::max_degree + 1);

/// Derivatives in s and t of the Bernstein polynomials at the Gauss points, one column per polynomial.
struct Table {
  Eigen::Matrix<double, points, Eigen::Dynamic> in_s, in_t;
};

Table table(int p) {
  const quadrature::TensorRule& rule = quadrature::tensor_gauss(4);
  Table result;
  result.in_s.resize(points, (p + 1) * (p + 1));
  result.in_t.resize(points, (p + 1) * (p + 1));
  double b[spline::max_degree + 1], b1[spline::max_degree + 1], c[spline::max_degree + 1], c1[spline::max_degree + 1];
  for (int q = 0; q < points; ++q) {
    spline::bernstein(p, rule.s[q], b, b1, nullptr);
    spline::bernstein(p, rule.t[q], c, c1, nullptr);
    for (int j = 0, k = 0; j <= p; ++j)
      for (int i = 0; i <= p; ++i, ++k) {
        result.in_s(q, k) = b1[i] * c[j];
        result.in_t(q, k) = b[i] * c1[j];
      }
  }
  return result;
}

using Tangents = Eigen::Array<double, points, 3>;

struct Worst {
  double jacobian_ratio, aspect_ratio;
  int point;
};

Worst worst(const Tangents& a1, const Tangents& a2) {
  Tangents n;
  for (int c = 0; c < 3; ++c) {
    const int d = (c + 1) % 3, e = (c + 2) % 3;
    n.col(c) = a1.col(d) * a2.col(e) - a1.col(e) * a2.col(d);
  }
  const auto lengths = [](const Tangents& a) { return a.matrix().rowwise().norm().sum(); };
  const Vec3 direction = n.colwise().sum().matrix().transpose().normalized();
  int least;
  const double smallest = (n.matrix() * direction).minCoeff(&least), ratio = lengths(a1) / lengths(a2);
  return {points * smallest / lengths(n), std::max(ratio, 1 / ratio), least};
}

}  // namespace

Quality quality(const BezierMap& map, const Net& net) {
  return quality(map, net, indices(map.n_elements()));
}

Quality worse(const Quality& a, const Quality& b) {
  Quality result = a.jacobian_ratio <= b.jacobian_ratio ? a : b;
  const Quality& stretched = a.aspect_ratio >= b.aspect_ratio ? a : b;
  result.aspect_ratio = stretched.aspect_ratio, result.stretched_element = stretched.stretched_element;
  return result;
}

Quality quality(const BezierMap& map, const Net& net, std::span<const int> elements) {
  for (int a = 0; a < net.rows(); ++a)
    if (!net.row(a).allFinite()) throw RunFailure("control point " + std::to_string(a) + " has become NaN");
  Quality result;
  double bezier[3 * most];
  Tangents a1, a2;
  for (const Block& block : map.blocks()) {
    const int n_b = (block.degree + 1) * (block.degree + 1);
    const Table derivatives = table(block.degree);
    const auto at_points = [&](const auto& rows, Tangents& out) {
      three_sums(points, n_b, rows.data(), bezier, out.data());
    };
    for (const int e : elements) {
      if (map.degree(e) != block.degree) continue;
      map.points(e, net, bezier);
      at_points(derivatives.in_s, a1);
      at_points(derivatives.in_t, a2);
      const Worst here = worst(a1, a2);
      if (here.jacobian_ratio < result.jacobian_ratio) {
        const quadrature::TensorRule& rule = quadrature::tensor_gauss(4);
        result.jacobian_ratio = here.jacobian_ratio;
        result.folded_element = e;
        result.folded_place = place({block.degree, bezier}, rule.s[here.point], rule.t[here.point]);
      }
      if (here.aspect_ratio > result.aspect_ratio) {
        result.aspect_ratio = here.aspect_ratio;
        result.stretched_element = e;
      }
    }
  }
  return result;
}

void require_sound(const Quality& quality, double least) {
  if (quality.jacobian_ratio > least) return;
  const Vec3& x = quality.folded_place;
  throw RunFailure(formatted("element %d is folded at (%g, %g, %g): its smallest Jacobian is %g times the mean", quality.folded_element, x[0], x[1],
                             x[2], quality.jacobian_ratio));
}

}  // namespace tanktread::surface
