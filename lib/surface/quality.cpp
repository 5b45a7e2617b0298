#include "surface/quality.hpp"

#include <cmath>
#include <numeric>
#include <sstream>
#include <vector>

#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {
namespace {

constexpr int points = 4;

/// Bernstein derivatives in s and t at the points of an element, shape (points^2, n_b).
struct Table {
  Eigen::MatrixXd in_s, in_t;
};
Table table(int p) {
  const quadrature::TensorRule& rule = quadrature::tensor_gauss(points);
  Table result{Eigen::MatrixXd(rule.size(), (p + 1) * (p + 1)), Eigen::MatrixXd(rule.size(), (p + 1) * (p + 1))};
  double b[spline::max_degree + 1], b1[spline::max_degree + 1], c[spline::max_degree + 1], c1[spline::max_degree + 1];
  for (int q = 0; q < rule.size(); ++q) {
    spline::bernstein(p, rule.s[q], b, b1, nullptr);
    spline::bernstein(p, rule.t[q], c, c1, nullptr);
    for (int j = 0, k = 0; j <= p; ++j) {
      for (int i = 0; i <= p; ++i, ++k) {
        result.in_s(q, k) = b1[i] * c[j];
        result.in_t(q, k) = b[i] * c1[j];
      }
    }
  }
  return result;
}

struct Worst {
  double jacobian_ratio, aspect_ratio;
  int point;
};
Worst worst(const Eigen::MatrixXd& a1, const Eigen::MatrixXd& a2) {
  Eigen::Matrix<double, points * points, 3> normals;
  for (int q = 0; q < normals.rows(); ++q) normals.row(q) = Vec3(a1.row(q)).cross(Vec3(a2.row(q))).transpose();
  const Vec3 direction = normals.colwise().sum().normalized().transpose();
  Worst result{};
  result.jacobian_ratio = (normals * direction).minCoeff(&result.point) / normals.rowwise().norm().mean();
  const double ratio = a1.rowwise().norm().sum() / a2.rowwise().norm().sum();
  result.aspect_ratio = std::max(ratio, 1 / ratio);
  return result;
}

}  // namespace

Quality quality(const BezierMap& map, const Net& net) {
  std::vector<int> all(map.n_elements());
  std::iota(all.begin(), all.end(), 0);
  return quality(map, net, all);
}

Quality worse(const Quality& a, const Quality& b) {
  Quality result = a.jacobian_ratio <= b.jacobian_ratio ? a : b;
  const Quality& stretched = a.aspect_ratio >= b.aspect_ratio ? a : b;
  result.aspect_ratio = stretched.aspect_ratio, result.stretched_element = stretched.stretched_element;
  return result;
}

Quality quality(const BezierMap& map, const Net& net, std::span<const int> elements) {
  for (int a = 0; a < net.rows(); ++a)
    if (!net.row(a).allFinite()) throw RunFailure("control point " + std::to_string(a) + " is no longer a number");
  Quality result;
  Eigen::MatrixXd bezier, a1, a2;
  for (const Block& block : map.blocks().blocks) {
    const Table derivatives = table(block.degree);
    bezier.resize((block.degree + 1) * (block.degree + 1), 3);
    for (const int e : elements) {
      if (map.degree(e) != block.degree) continue;
      map.points(e, net, bezier.data());
      a1.noalias() = derivatives.in_s * bezier;
      a2.noalias() = derivatives.in_t * bezier;
      const Worst here = worst(a1, a2);
      if (here.jacobian_ratio < result.jacobian_ratio) {
        const quadrature::TensorRule& rule = quadrature::tensor_gauss(points);
        result.jacobian_ratio = here.jacobian_ratio;
        result.folded_element = e;
        result.folded_place = place({block.degree, bezier.data()}, rule.s[here.point], rule.t[here.point]);
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
  std::ostringstream text;
  text << "element " << quality.folded_element << " is folded at (" << quality.folded_place[0] << ", " << quality.folded_place[1] << ", "
       << quality.folded_place[2] << "): its smallest Jacobian is " << quality.jacobian_ratio << " times the mean";
  throw RunFailure(text.str());
}

}  // namespace tanktread::surface
