#pragma once
// Finds the balls that contain a point.

#include <cmath>
#include <vector>

#include <unsupported/Eigen/BVH>

#include "base/types.hpp"

namespace tanktread::stokes {

struct Ball {
  Vec3 centre;
  double square;  ///< squared radius
  int index;
};

inline Eigen::AlignedBox3d bounding_box(const Ball& ball) {
  const Vec3 radius = Vec3::Constant(std::sqrt(ball.square));
  return {ball.centre - radius, ball.centre + radius};
}

/// Balls of different sizes in a binary tree of boxes. Finding the balls that contain a point takes a time that grows with the logarithm of the
/// number of balls.
class Vicinity {
 public:
  void set_balls(const std::vector<Ball>& balls) { tree_.init(balls.begin(), balls.end()); }

  /// Lists the indices of the balls that contain the point, in no particular order.
  void list(const Vec3& point, std::vector<int>& holding) const {
    Search search{point, holding};
    Eigen::BVIntersect(tree_, search);
  }

 private:
  struct Search {
    const Vec3& point;
    std::vector<int>& holding;

    bool intersectVolume(const Eigen::AlignedBox3d& box) const { return box.contains(point); }
    bool intersectObject(const Ball& ball) const {
      if ((ball.centre - point).squaredNorm() < ball.square) holding.push_back(ball.index);
      return false;  // the search continues
    }
  };
  Eigen::KdBVH<double, 3, Ball> tree_;
};

}  // namespace tanktread::stokes
