#include "surface/quality.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <vector>

#include "base/errors.hpp"
#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"
#include "surface/patch.hpp"
#include "surface/three_sums.hpp"

namespace tanktread::surface {
namespace {

constexpr int points = 16;  ///< 4 x 4
constexpr int most = (spline::max_degree + 1) * (spline::max_degree + 1);

/// Derivatives in s and t of Bernstein polynomial b at point q, in 16 b + q.
struct Table {
  std::vector<double> in_s, in_t;
};

Table table(int p) {
  const quadrature::TensorRule& rule = quadrature::tensor_gauss(4);
  const auto size = static_cast<std::size_t>(points * (p + 1) * (p + 1));
  Table result{std::vector<double>(size), std::vector<double>(size)};
  double b[spline::max_degree + 1], b1[spline::max_degree + 1], c[spline::max_degree + 1], c1[spline::max_degree + 1];
  for (int q = 0; q < points; ++q) {
    spline::bernstein(p, rule.s[q], b, b1, nullptr);
    spline::bernstein(p, rule.t[q], c, c1, nullptr);
    for (int j = 0, k = 0; j <= p; ++j) {
      for (int i = 0; i <= p; ++i, ++k) {
        result.in_s[static_cast<std::size_t>(points * k + q)] = b1[i] * c[j];
        result.in_t[static_cast<std::size_t>(points * k + q)] = b[i] * c1[j];
      }
    }
  }
  return result;
}

struct Worst {
  double jacobian_ratio, aspect_ratio;
  int point;
};

/// From the tangents at the points, (3, 16).
Worst worst(const double* a1, const double* a2) {
  double n[3][points], length[points], length_1[points], length_2[points], along[points];
  for (int q = 0; q < points; ++q) {
    const double x1 = a1[q], y1 = a1[points + q], z1 = a1[2 * points + q], x2 = a2[q], y2 = a2[points + q], z2 = a2[2 * points + q];
    n[0][q] = y1 * z2 - z1 * y2, n[1][q] = z1 * x2 - x1 * z2, n[2][q] = x1 * y2 - y1 * x2;
    length[q] = std::sqrt(n[0][q] * n[0][q] + n[1][q] * n[1][q] + n[2][q] * n[2][q]);
    length_1[q] = std::sqrt(x1 * x1 + y1 * y1 + z1 * z1);
    length_2[q] = std::sqrt(x2 * x2 + y2 * y2 + z2 * z2);
  }
  const auto sum = [](const double* numbers) { return std::accumulate(numbers, numbers + points, 0.); };
  const Vec3 direction = Vec3(sum(n[0]), sum(n[1]), sum(n[2])).normalized();
  for (int q = 0; q < points; ++q) along[q] = n[0][q] * direction[0] + n[1][q] * direction[1] + n[2][q] * direction[2];
  const double* const least = std::min_element(along, along + points);
  const double ratio = sum(length_1) / sum(length_2);
  return {points * *least / sum(length), std::max(ratio, 1 / ratio), static_cast<int>(least - along)};
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
  double bezier[3 * most], a1[3 * points], a2[3 * points];
  for (const Block& block : map.blocks().blocks) {
    const int n_b = (block.degree + 1) * (block.degree + 1);
    const Table derivatives = table(block.degree);
    const auto at_points = [&](const std::vector<double>& rows, double* out) {
      three_sums(points, n_b, rows.data(), bezier, out);
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
  std::ostringstream text;
  text << "element " << quality.folded_element << " is folded at (" << quality.folded_place[0] << ", " << quality.folded_place[1] << ", "
       << quality.folded_place[2] << "): its smallest Jacobian is " << quality.jacobian_ratio << " times the mean";
  throw RunFailure(text.str());
}

}  // namespace tanktread::surface
