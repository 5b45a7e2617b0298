#pragma once
// A plane no-slip wall.

#include <memory>
#include <string>

#include <Eigen/Geometry>

#include "base/types.hpp"
#include "stokes/medium/medium.hpp"

namespace tanktread::stokes {

/// Condition on flows in front of a wall, for messages.
constexpr const char* along_the_wall = "a flow must be along the wall and the same everywhere on it";

/// Wall through `point` with `normal` pointing into the fluid. The wall may move tangentially at a constant velocity, which is not stored here. As a
/// medium it acts by images of the surfaces (WallImages).
class PlaneWall : public Medium {
 public:
  PlaneWall(const Vec3& point, const Vec3& normal) : point_(point), normal_(normal.normalized()) {
    const Vec3 first = normal_.cwiseAbs() == Vec3(0, 0, 1) ? Vec3::UnitX() : Vec3(normal_.unitOrthogonal());
    axes_ << first.transpose(), normal_.cross(first).transpose(), normal_.transpose();
  }

  const Vec3& point() const { return point_; }
  const Vec3& normal() const { return normal_; }                          ///< unit normal
  const Mat3& axes() const { return axes_; }                              ///< rows: two tangential axes, then the normal
  double height(const Vec3& x) const { return normal_.dot(x - point_); }  ///< height above the wall, negative behind it
  Vec3 mirrored(const Vec3& x) const { return x - 2 * height(x) * normal_; }
  Vec3 in_axes(const Vec3& x) const { return axes_ * (x - point_); }  ///< position relative to `point` in the wall's axes

  std::unique_ptr<LayerMedium> in_layer(const LayerSources& sources, bool by_clusters) const override;
  bool contains(const Vec3& x) const override { return height(x) > 0; }
  /// The flow must be along the wall and uniform on it. Compares velocities at six points of the wall.
  std::string refusal(const AmbientFlow& flow) const override;
  bool keeps(const Vec3& signs) const override { return signs.cwiseProduct(normal_) == normal_; }

 private:
  Vec3 point_, normal_;
  Mat3 axes_;
};

}  // namespace tanktread::stokes
