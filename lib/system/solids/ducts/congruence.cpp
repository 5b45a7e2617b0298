#include "system/solids/ducts/congruence.hpp"

#include <cmath>
#include <numbers>

namespace tanktread::coupling {
namespace {

/// Returns the row of `ring` (points around one cross-section) whose distance from the position `at` is below `close`; -1 if there is none.
int row_at(const Eigen::Ref<const Net>& ring, const Vec3& at, double close) {
  Eigen::Index row;
  return (ring.rowwise() - at.transpose()).rowwise().norm().minCoeff(&row) < close ? static_cast<int>(row) : -1;
}

/// Returns whether the matrix map.q maps point k of each ring to point map.image[k] of the same ring, up to the distance `close`. A ring is m
/// consecutive rows of `points`, where m is the size of map.image.
bool maps(const WallSymmetry& map, const Net& points, double close) {
  const auto m = static_cast<Eigen::Index>(map.image.size());
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (!((points.row(i - i % m + map.image[static_cast<std::size_t>(i % m)]) - points.row(i) * map.q.transpose()).norm() < close)) return false;
  return true;
}

}  // namespace

std::vector<WallSymmetry> wall_symmetries(const surface::TubeWall& wall, const Net& sites) {
  const int m = wall.n_around;
  const double close = 1e-10 * wall.radius();
  std::vector<WallSymmetry> all;
  for (const double sign : {1., -1.})
    for (int j = 0; j < m; ++j) {
      const double angle = 2 * std::numbers::pi * j / m, c = std::cos(angle), s = std::sin(angle);
      WallSymmetry map{(Mat3() << 1, 0, 0, 0, c, -sign * s, 0, s, sign * c).finished(), {}, std::vector<int>(static_cast<std::size_t>(m))};
      for (int k = 0; k < m; ++k) {
        const int to = row_at(sites.topRows(m), map.q * sites.row(k).transpose(), close);
        if (to < 0) break;
        map.image.push_back(to);
        map.source[static_cast<std::size_t>(to)] = k;
      }
      if (static_cast<int>(map.image.size()) == m && maps(map, sites, close) && maps(map, wall.net, close)) all.push_back(std::move(map));
    }
  return all;
}

std::vector<OrbitRepresentative> orbit_representatives(const std::vector<WallSymmetry>& maps, int n_around) {
  std::vector<OrbitRepresentative> all;
  for (int k = 0; k < n_around; ++k) {
    OrbitRepresentative of{k, &maps.front()};
    for (const WallSymmetry& map : maps)
      if (const int point = map.source[static_cast<std::size_t>(k)]; point < of.point) of = {point, &map};
    all.push_back(of);
  }
  return all;
}

}  // namespace tanktread::coupling
