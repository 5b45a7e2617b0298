#pragma once
// Weight of a deformable particle.

#include "membrane/load.hpp"
#include "surface/geometry.hpp"

namespace tanktread::membrane {

/// Load of a uniform body force f, force/length^3, on the enclosed volume. Its energy is -int f.x dV.
class Weight : public Load {
 public:
  /// `space` must outlive this object.
  Weight(const spline::Space& space, const Vec3& body_force) : geometry_(space), body_force_(body_force) {}

  void add_work(const Net& x, std::span<const int> elements, Net& work, std::span<Net> /*sums*/) const override {
    geometry_.add_moment_gradient(x, -body_force_, x.colwise().mean().transpose(), elements, work);
  }
  bool admits(const surface::Image& image) const override { return image.signs.cwiseProduct(body_force_) == body_force_; }
  RigidConditions rigid_conditions() const override { return fixed_direction(body_force_); }
  bool depends_on_labels() const override { return false; }

 private:
  surface::Geometry geometry_;
  Vec3 body_force_;
};

}  // namespace tanktread::membrane
