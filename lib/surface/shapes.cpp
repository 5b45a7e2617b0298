#include "surface/shapes.hpp"

#include <vector>

#include <Eigen/LU>

#include "surface/cube_sphere.hpp"
#include "surface/geometry.hpp"
#include "surface/polar_sphere.hpp"

namespace tanktread::surface {
namespace {

/// The k for which the mesh is the uniform one of 3 * 2^k elements a side, or -1.
int subdivisions(const spline::TMesh& mesh, int n_points) {
  int level = 0, n = 3;
  while (6 * n * n + 2 < n_points) n *= 2, ++level;
  return 6 * n * n + 2 == n_points && mesh.lattice->units % n == 0 ? level : -1;
}

/// Control points to start from: the subdivided net itself where the mesh is one, elsewhere points of its limit surface.
Net smooth_start(const spline::TMesh& mesh) {
  const std::vector<int> vertices = spline::anchors(mesh);
  const int level = subdivisions(mesh, static_cast<int>(vertices.size()));
  const CubeSphere sphere(level < 0 ? 5 : level);
  Net net(vertices.size(), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3& on_cube = mesh.lattice->position[vertices[i]];
    net.row(i) = (level < 0 ? sphere.limit_point(on_cube) : sphere.net_point(on_cube)).transpose();
  }
  return net;
}

}  // namespace

Net unit_sphere(const spline::TMesh& mesh, const LeastSquaresFit& fit, int fits) {
  Net net = smooth_start(mesh);
  for (int k = 0; k < fits; ++k) net = fit.fit_image(net, [](const Vec3& x) -> Vec3 { return x.normalized(); });
  return net;
}

Vec3 red_cell(const Vec3& x) {
  const double r2 = x[0] * x[0] + x[1] * x[1];
  return {x[0], x[1], x[2] / 2 * (0.21 + 2.0 * r2 - 1.12 * r2 * r2)};
}

namespace {

/// From the unit sphere, or the red cell of unit radius, to the shape about its centre.
Mat3 map_of(const ParticleShape& shape) {
  const Vec3 semi_axes = shape.semi_axes ? *shape.semi_axes : Vec3::Constant(shape.radius.value_or(1));
  return shape.rotation() * semi_axes.asDiagonal();
}

}  // namespace

Net resting_shape(const LeastSquaresFit& fit, const Net& unit_sphere, const ParticleShape& shape) {
  Net net = unit_sphere;
  if (shape.shape == "red cell") net = fit.fit_image(net, [](const Vec3& x) { return red_cell(x.normalized()); });
  net = net * map_of(shape).transpose();
  net.rowwise() += shape.center.transpose();
  return net;
}

Net fitted_again(const spline::Space& space, const Net& net, const ParticleShape& shape) {
  if (shape.shape == "red cell" || shape.shape == "file") return net;
  const LeastSquaresFit fit(space);
  Net sphere = (net.rowwise() - shape.center.transpose()) * map_of(shape).inverse().transpose();
  for (int k = 0; k < 3; ++k) sphere = fit.fit_image(sphere, [](const Vec3& x) -> Vec3 { return x.normalized(); });
  return resting_shape(fit, sphere, shape);
}

Net initial_shape(const spline::Space& space, const spline::TMesh& mesh, const ParticleShape& shape) {
  const LeastSquaresFit fit(space);
  return resting_shape(fit, unit_sphere(mesh, fit), shape);
}

Net initial_shape(const spline::Space& space, const spline::PolarMesh& mesh, int axis, const ParticleShape& shape) {
  return resting_shape(LeastSquaresFit(space), unit_sphere(mesh, space, axis), shape);
}

Net imported_shape(const ParticleShape& shape) {
  const auto& [space, net] = *shape.imported;
  const Vec3 centroid = measures(space, net).centroid;
  return ((net.rowwise() - centroid.transpose()) * shape.rotation().transpose()).rowwise() + shape.center.transpose();
}

}  // namespace tanktread::surface
