#include "surface/shape_velocity.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

namespace {

constexpr int n = 16;  // solid harmonics of degree three at most
using Values = Eigen::Matrix<double, n, 1>;

Values harmonics(const Vec3& at) {
  const double x = at[0], y = at[1], z = at[2], xx = x * x, yy = y * y, zz = z * z;
  Values h;
  h << 1, x, y, z, x * y, y * z, z * x, xx - yy, 2 * zz - xx - yy, x * (xx - 3 * yy), y * (3 * xx - yy), z * (xx - yy), x * y * z,
      x * (4 * zz - xx - yy), y * (4 * zz - xx - yy), z * (2 * zz - 3 * xx - 3 * yy);
  return h;
}

/// Integrals over the surface: of products of harmonics, harmonics times v.n, harmonics times n; the last of these with x/R are 3 V/R.
struct Sums {
  Eigen::Map<Eigen::Matrix<double, n, n>> products;
  Eigen::Map<Values> motion;
  Eigen::Map<Eigen::Matrix<double, n, 3>> normals;
  static constexpr int size = n * n + n + 3 * n;
  explicit Sums(double* numbers) : products(numbers), motion(numbers + n * n), normals(numbers + n * n + n) {}
};

}  // namespace

std::vector<double> shape_velocity_sums(const BezierMap& map, const Net& x, const Net& v, double radius, std::span<const int> elements) {
  const quadrature::TensorRule& rule = quadrature::tensor_gauss(3);
  const Vec3 mean = x.colwise().mean().transpose();
  std::vector<double> numbers(Sums::size, 0.);
  Sums sums(numbers.data());
  constexpr int most = 3 * (spline::max_degree + 1) * (spline::max_degree + 1);
  double points[most], velocities[most];
  for (const int e : elements) {
    map.points(e, x, points);
    map.points(e, v, velocities);
    for (int q = 0; q < rule.size(); ++q) {
      const Jet at = jet({map.degree(e), points}, rule.s[q], rule.t[q]);
      const Vec3 normal = rule.weights[q] * at.s.cross(at.t), velocity = place({map.degree(e), velocities}, rule.s[q], rule.t[q]);
      const Values h = harmonics((at.x - mean) / radius);
      sums.products += normal.norm() * h * h.transpose();
      sums.motion += velocity.dot(normal) * h;
      sums.normals += h * normal.transpose();
    }
  }
  return numbers;
}

double shape_velocity(std::span<const double> sums, bool along_x1) {
  std::vector<double> numbers(sums.begin(), sums.end());
  const Sums all(numbers.data());
  const Mat3 moments = all.normals.block<3, 3>(1, 0);  // V/R times the identity, but for the rule; with them a translation has no rest
  Vec3 frame = moments.partialPivLu().solve(Vec3(all.motion.segment<3>(1)));
  if (along_x1) frame.tail<2>().setZero();
  const Values motion = all.motion - all.normals * frame;
  return std::sqrt(std::max(0.0, motion.dot(all.products.ldlt().solve(motion))) / all.products(0, 0));
}

}  // namespace tanktread::surface
