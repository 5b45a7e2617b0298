#include "surface/transport.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "surface/element_groups.hpp"
#include "surface/extremes.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

namespace {

/// A corner of a grid triangle: position x, velocity v, unstressed position (if the membrane has one), height above the plane x2 = centre_2 through
/// the centroid.
struct Corner {
  Vec3 x, v, unstressed;
  double height;
};

/// Sums over the parts of the section curve that cut() has added. `circulation`: integral of the tangential velocity. `length`: length of the curve.
/// `weight`: sum of the weights in the mean frequency (6.6). `turned`: sum of the angular velocity times this weight. `centre`, `of_centre`: centroid
/// and its velocity. `elastic`: true if the weights are lengths on the unstressed surface, false if they are times.
struct Circuit {
  Vec3 centre, of_centre;
  bool elastic;
  double circulation = 0, length = 0, weight = 0, turned = 0;
  // onwards: true if a part of the section curve moves along e2 x n, with the outward normal n. backwards: true if a part moves in the opposite
  // direction
  bool onwards = false, backwards = false;

  /// Adds the part of the section curve x2 = centre_2 that lies in a flat triangle, whose corners run counter-clockwise seen from outside.
  void cut(const Corner& a, const Corner& b, const Corner& c) {
    const bool above[3] = {a.height >= 0, b.height >= 0, c.height >= 0};
    if (above[0] == above[1] && above[1] == above[2]) return;
    const std::array<const Corner*, 3> corners = {&a, &b, &c};
    std::array<Vec3, 2> x, v, unstressed;
    size_t n = 0;
    for (size_t k = 0; k < 3; ++k) {
      const Corner &from = *corners[k], &to = *corners[(k + 1) % 3];
      if ((from.height >= 0) == (to.height >= 0)) continue;
      const double share = from.height / (from.height - to.height);
      x[n] = from.x + share * (to.x - from.x);
      v[n] = from.v + share * (to.v - from.v) - of_centre;
      unstressed[n++] = from.unstressed + share * (to.unstressed - from.unstressed);
    }
    const Vec3 normal = (b.x - a.x).cross(c.x - a.x), along = x[1] - x[0];
    // skips the triangle if the plane meets only one of its corners, because round-off would determine the direction
    if (along.norm() < 1e-9 * (b.x - a.x).norm()) return;
    const double sense = along.dot(Vec3::UnitY().cross(normal)) > 0 ? 1 : -1;
    const double treads = sense * along.dot(v[0] + v[1]) / 2;
    circulation += treads;
    length += along.norm();
    (treads > 0 ? onwards : backwards) = true;
    const double passed = elastic ? (unstressed[1] - unstressed[0]).norm() : along.squaredNorm() / std::abs(treads);
    const Vec3 y = (x[0] + x[1]) / 2 - centre, moves = (v[0] + v[1]) / 2;
    weight += passed;
    turned += passed * (y[2] * moves[0] - y[0] * moves[2]) / (y[0] * y[0] + y[2] * y[2]);
  }

  TankTreading treading() const {
    if (!(length > 0)) return {};
    const bool turns = weight > 0 && std::isfinite(weight) && (elastic || onwards != backwards);
    return {circulation / length, turns ? turned / weight : 0};
  }
};

using kernel::n_harmonics;
using Values = Eigen::Matrix<double, n_harmonics, 1>;

/// Integrals over the surface scaled by 1/R, with the solid harmonics h_i. `products`: int h_i h_j dGamma, lower triangle only. `motion`:
/// int h_i v.n dGamma. `normals`: int h_i n dGamma. The integrals of x_i n_i are V/R^3 each, where V is the volume.
struct Sums {
  Eigen::Map<Eigen::Matrix<double, n_harmonics, n_harmonics>> products;
  Eigen::Map<Values> motion;
  Eigen::Map<Eigen::Matrix<double, n_harmonics, 3>> normals;
  static constexpr int size = n_harmonics * (n_harmonics + 4);
  explicit Sums(double* numbers)
      : products(numbers), motion(numbers + n_harmonics * n_harmonics), normals(numbers + n_harmonics * (n_harmonics + 1)) {}
};

}  // namespace

TankTreading tank_treading(const BezierMap& map, const Net& x, const Net& v, const Net* unstressed, const Vec3& centre, const Vec3& of_centre) {
  Circuit circuit{centre, of_centre, unstressed != nullptr};
  // points are treated as points of the plane x2 = centre_2 if their distance from it is below this tolerance
  const double in_plane = 1e-9 * (x.rowwise() - centre.transpose()).cwiseAbs().maxCoeff();
  const Patches places(map, x);
  for (int e = 0; e < map.n_elements(); ++e) {
    const auto [low, high] = hull(places[e], 1);
    if (low > centre[1] + in_plane || high < centre[1] - in_plane) continue;
    const auto sampled = [&](const Net& net) { return sample(Patches(map, net, {&e, 1})[0]); };
    const Grid<Vec3> at = sample(places[e]), moves = sampled(v), before = unstressed ? sampled(*unstressed) : at;
    const auto corner = [&](size_t j, size_t i) {
      const double height = at[j][i][1] - centre[1];
      return Corner{at[j][i], moves[j][i], before[j][i], std::abs(height) < in_plane ? 0 : height};
    };
    for (size_t j = 0; j < cells; ++j)
      for (size_t i = 0; i < cells; ++i) {
        circuit.cut(corner(j, i), corner(j, i + 1), corner(j + 1, i + 1));
        circuit.cut(corner(j, i), corner(j + 1, i + 1), corner(j + 1, i));
      }
  }
  return circuit.treading();
}

std::vector<double> shape_velocity_sums(const BezierMap& map, const Net& x, const Net& v, double radius, std::span<const int> elements) {
  const Net here = (x.rowwise() - x.colwise().mean()) / radius;
  std::vector<double> numbers(Sums::size, 0.);
  Sums sums(numbers.data());
  each_group<kernel::ShapeMotion>(
      map, elements,
      [&](int degree, std::span<const int> group, kernel::ShapeMotion& part) {
        kernel::shape_motion(degree, points_of(map, here, group), points_of(map, v, group), part);
      },
      [&](std::span<const int> group, const kernel::ShapeMotion& part) {
        for (std::size_t l = 0; l < group.size(); ++l)
          for (int i = 0, k = 0; i < n_harmonics; ++i) {
            for (int j = i; j < n_harmonics; ++j) sums.products(j, i) += part.products[k++][l];
            sums.motion[i] += part.motion[i][l];
            for (int c = 0; c < 3; ++c) sums.normals(i, c) += part.normals[i][c][l];
          }
      });
  return numbers;
}

double shape_velocity(std::span<const double> sums, bool along_x1) {
  std::vector<double> numbers(sums.begin(), sums.end());
  const Sums all(numbers.data());
  // int x_i n_j dGamma / R^3, which is V/R^3 times the identity except for quadrature errors. With the exact V instead of this integral, a
  // translation would leave a residual.
  const Mat3 moments = all.normals.block<3, 3>(1, 0);
  Vec3 frame = moments.partialPivLu().solve(Vec3(all.motion.segment<3>(1)));
  if (along_x1) frame.tail<2>().setZero();
  const Values motion = all.motion - all.normals * frame;
  return std::sqrt(std::max(0.0, motion.dot(all.products.ldlt().solve(motion))) / all.products(0, 0));
}

}  // namespace tanktread::surface
