#pragma once
// A plane no-slip wall.

#include <span>

#include <Eigen/Geometry>

#include "base/types.hpp"

namespace tanktread::stokes {

/// Wall through `point` with `normal` pointing into the fluid. The wall may move tangentially at a constant velocity, which is not stored here.
class PlaneWall {
 public:
  PlaneWall(const Vec3& point, const Vec3& normal) : point_(point), normal_(normal.normalized()) {
    const Vec3 first = normal_.cwiseAbs() == Vec3(0, 0, 1) ? Vec3::UnitX() : Vec3(normal_.unitOrthogonal());
    axes_ << first.transpose(), normal_.cross(first).transpose(), normal_.transpose();
  }

  const Vec3& point() const { return point_; }
  const Vec3& normal() const { return normal_; }    ///< unit normal
  const Mat3& axes() const { return axes_; }        ///< rows: two tangential axes, then the normal
  double height(const Vec3& x) const { return normal_.dot(x - point_); }  ///< height above the wall, negative behind it
  Vec3 mirrored(const Vec3& x) const { return x - 2 * height(x) * normal_; }
  Vec3 in_axes(const Vec3& x) const { return axes_ * (x - point_); }  ///< position relative to `point` in the wall's axes

 private:
  Vec3 point_, normal_;
  Mat3 axes_;
};

/// Returns whether all points are in front of all walls.
inline bool in_front(std::span<const PlaneWall> walls, const Net& at) {
  for (const PlaneWall& wall : walls)
    for (Eigen::Index i = 0; i < at.rows(); ++i)
      if (!(wall.height(at.row(i).transpose()) > 0)) return false;
  return true;
}

}  // namespace tanktread::stokes
