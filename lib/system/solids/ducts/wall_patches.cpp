#include "system/solids/ducts/wall_patches.hpp"

#include <algorithm>

#include <Eigen/LU>

namespace tanktread::coupling {

namespace {

constexpr int reach = 2;

/// Returns the control points at most `distance` rows and columns away from the control point `point`, in ascending order.
std::vector<int> around(const surface::TubeWall& wall, int point, int distance) {
  const int m = wall.n_around, i = point / m, k = point % m;
  std::vector<int> points;
  for (int a = std::max(0, i - distance); a <= std::min(wall.n_along - 1, i + distance); ++a)
    for (int b = k - distance; b <= k + distance; ++b) points.push_back(a * m + (b % m + m) % m);
  std::ranges::sort(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/// Returns the symmetric matrix with the entries 11, 12, 13, 22, 23, 33.
Mat3 block(const double* entries) {
  return (Mat3() << entries[0], entries[1], entries[2], entries[1], entries[3], entries[4], entries[2], entries[4], entries[5]).finished();
}

}  // namespace

WallPatches::WallPatches(const surface::TubeWall& wall, stokes::Layer& layer, const std::vector<int>& points) {
  const int n = wall.space.n_points;
  std::vector<int> all(static_cast<std::size_t>(n));
  stokes::NearPoints near;
  for (int i = 0; i < n; ++i) {
    all[static_cast<std::size_t>(i)] = i;
    const std::vector<int> of_row = around(wall, i, 2 * reach);
    near.point.insert(near.point.end(), of_row.begin(), of_row.end());
    near.first.push_back(near.point.size());
  }
  std::vector<double> entries;
  layer.assemble(all, near, entries);
  for (const int i : points) {
    Patch patch{i, around(wall, i, reach), {}};
    const auto size = static_cast<Eigen::Index>(patch.neighbours.size());
    Eigen::MatrixXd transposed(3 * size, 3 * size);
    Eigen::Index own = 0;
    for (Eigen::Index a = 0; a < size; ++a) {
      const int from = patch.neighbours[static_cast<std::size_t>(a)];
      if (from == i) own = a;
      const auto first = near.point.begin() + static_cast<std::ptrdiff_t>(near.first[static_cast<std::size_t>(from)]);
      const auto last = near.point.begin() + static_cast<std::ptrdiff_t>(near.first[static_cast<std::size_t>(from) + 1]);
      for (Eigen::Index b = 0; b < size; ++b) {
        const auto at = std::lower_bound(first, last, patch.neighbours[static_cast<std::size_t>(b)]) - near.point.begin();
        transposed.block<3, 3>(3 * b, 3 * a) = block(&entries[6 * static_cast<std::size_t>(at)]);
      }
    }
    const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(3 * size, 3 * size).middleCols(3 * own, 3);
    patch.row = transposed.partialPivLu().solve(unit).transpose();
    patches_.push_back(std::move(patch));
  }
}

void WallPatches::apply(const Net& rhs, Net& f) const {
  for (const Patch& patch : patches_) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < patch.neighbours.size(); ++k)
      sum += patch.row.middleCols<3>(3 * static_cast<Eigen::Index>(k)) * rhs.row(patch.neighbours[k]).transpose();
    f.row(patch.point) = sum.transpose();
  }
}

}  // namespace tanktread::coupling
