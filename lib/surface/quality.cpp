#include "surface/quality.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"
#include "surface/patch.hpp"
#include "surface/three_sums.hpp"

namespace tanktread::surface {
namespace {

constexpr int points = 16;  ///< 4 x 4
constexpr int most = (spline::most_polynomial_degree + 1) * (spline::most_polynomial_degree + 1);

using Tangents = Eigen::Array<double, points, 3>;

struct Worst {
  double jacobian_ratio, aspect_ratio, tilt;
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
  const Eigen::VectorXd along = n.matrix() * direction;
  const double smallest = along.minCoeff(&least), ratio = lengths(a1) / lengths(a2);
  const double cosine = along.cwiseQuotient(n.matrix().rowwise().norm()).minCoeff();
  return {points * smallest / lengths(n), std::max(ratio, 1 / ratio), std::acos(std::clamp(cosine, -1., 1.)), least};
}

}  // namespace

Quality worse(const Quality& a, const Quality& b) {
  Quality result = a.jacobian_ratio <= b.jacobian_ratio ? a : b;
  const Quality& stretched = a.aspect_ratio >= b.aspect_ratio ? a : b;
  result.aspect_ratio = stretched.aspect_ratio, result.stretched_element = stretched.stretched_element;
  result.tilt = std::max(a.tilt, b.tilt);
  return result;
}

Quality quality(const BezierMap& map, const Net& net, std::span<const int> elements) {
  for (int a = 0; a < net.rows(); ++a)
    if (!net.row(a).allFinite()) throw RunFailure("control point " + std::to_string(a) + " has become NaN");
  Quality result;
  double bezier[3 * most];
  Tangents a1, a2;
  const quadrature::TensorRule& rule = quadrature::tensor_gauss(4);
  for (const DegreeGroup& group : map.groups()) {
    const int n_b = (group.degree + 1) * (group.degree + 1);
    const spline::TensorBernstein polynomials = spline::tensor_bernstein(group.degree, rule.s, rule.t);
    for (const int e : elements) {
      if (map.degree(e) != group.degree) continue;
      map.points(e, net, bezier);
      three_sums(points, n_b, polynomials.s.data(), bezier, a1.data());
      three_sums(points, n_b, polynomials.t.data(), bezier, a2.data());
      const Worst here = worst(a1, a2);
      result.tilt = std::max(result.tilt, here.tilt);
      if (here.jacobian_ratio < result.jacobian_ratio) {
        result.jacobian_ratio = here.jacobian_ratio;
        result.folded_element = e;
        result.folded_place = position({group.degree, bezier}, rule.s[here.point], rule.t[here.point]);
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
