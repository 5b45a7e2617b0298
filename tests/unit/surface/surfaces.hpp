#pragma once
// Surfaces shared by several tests.

#include <random>

#include "spline/extraction.hpp"
#include "surface/shapes.hpp"

namespace tanktread::surface {

struct CubeMesh {
  spline::TMesh mesh;
  spline::Space space;

  explicit CubeMesh(int n, spline::ExtraordinaryRule rule = spline::ExtraordinaryRule::g1)
      : mesh(spline::cube(n)), space(spline::space(mesh, rule)) {}
  Net shape(const ParticleShape& shape) const { return resting_shape(space, mesh, shape); }
  Net sphere() const {
    ParticleShape shape;
    shape.radius = 1;
    return resting_shape(space, mesh, shape);
  }
  Net ellipsoid(const Vec3& semi_axes, const Vec3& orientation = Vec3::Zero(), const Vec3& center = Vec3::Zero()) const {
    ParticleShape shape;
    shape.shape = "ellipsoid";
    shape.semi_axes = semi_axes;
    shape.orientation = orientation;
    shape.center = center;
    return resting_shape(space, mesh, shape);
  }
  /// Returns an ellipsoid in general position with every control point moved at random: no symmetry, and all effects are large enough to be seen.
  Net crumpled(double amplitude, unsigned seed = 1) const {
    Net net = ellipsoid({1.4, 1.0, 0.8}, {20, -35, 50}, {0.3, -0.2, 0.1});
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-amplitude, amplitude);
    for (int a = 0; a < net.rows(); ++a)
      for (int c = 0; c < 3; ++c) net(a, c) += any(random);
    return net;
  }
};

}  // namespace tanktread::surface
