#include "surface/shapes.hpp"

#include <array>
#include <vector>

#include "surface/cube_sphere.hpp"

namespace tanktread::surface {
Net unit_sphere(const spline::Space& space, const spline::TMesh& mesh, const LeastSquaresFit& fit, int fits) {
  const CubeSphere sphere;
  const std::vector<int> vertices = spline::anchors(mesh);
  Net net(space.n_points, 3);
  for (int i = 0; i < space.n_points; ++i) net.row(i) = sphere(mesh.lattice->position[vertices[i]]).transpose();
  for (int k = 0; k < fits; ++k) net = fit.fit_image(net, [](const Vec3& x) -> Vec3 { return x.normalized(); });
  return net;
}

Vec3 red_cell(const Vec3& x) {
  const double r2 = x[0] * x[0] + x[1] * x[1];
  return {x[0], x[1], x[2] / 2 * (0.21 + 2.0 * r2 - 1.12 * r2 * r2)};
}

Net initial_shape(const spline::Space& space, const spline::TMesh& mesh, const ParticleShape& shape) {
  const LeastSquaresFit fit(space);
  Net net = unit_sphere(space, mesh, fit);
  if (shape.shape == "red cell") net = fit.fit_image(net, [](const Vec3& x) { return red_cell(x.normalized()); });
  const Vec3 semi_axes = shape.semi_axes ? *shape.semi_axes : Vec3::Constant(shape.radius.value_or(1));
  const Mat3 map = shape.rotation() * semi_axes.asDiagonal();
  net = net * map.transpose();
  net.rowwise() += shape.center.transpose();
  return net;
}

}  // namespace tanktread::surface
