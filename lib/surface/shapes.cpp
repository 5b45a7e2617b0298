#include "surface/shapes.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include <Eigen/LU>

#include "spline/extraction.hpp"
#include "spline/locate.hpp"
#include "surface/geometry.hpp"

namespace tanktread::surface {

namespace {

/// Returns k if the mesh is uniform with 3 * 2^k elements per side of the cube, otherwise -1.
int subdivisions(const spline::TMesh& mesh, int n_points) {
  int level = 0, n = 3;
  while (6 * n * n + 2 < n_points) n *= 2, ++level;
  return 6 * n * n + 2 == n_points && mesh.lattice->units % n == 0 ? level : -1;
}

/// Returns the initial net of 3 x 3 elements per face of the cube, in one row per lattice vertex. Only the rows of vertices of this net are used.
Net coarse_net(const spline::Lattice& l) {
  constexpr double edge = 1. / 3, inner = 0.26;
  Net net(l.vertices(), 3);
  for (int v = 0; v < l.vertices(); ++v) {
    const auto p = l.position[v].array();
    const double near = (p.abs() < 0.9).count() == 2 ? inner : edge;
    net.row(v) = (p.abs() < 0.9).select(p.sign() * near, p).matrix().normalized().transpose();
  }
  return net;
}

/// Subdivides a net whose vertices are `h` lattice units apart (Catmull-Clark). Face points are means of the corners; edge points are means of both
/// ends and of both adjacent face points. A vertex P of valence N moves to (Q + 2 R + (N - 3) P)/N, with Q the mean of the adjacent face points and R
/// the mean of the midpoints of its edges. Each face adds its part of these means.
Net subdivided(const spline::Lattice& l, int h, const Net& net) {
  Net fine = Net::Zero(net.rows(), 3);
  for (int c = 0; c < l.cells(); ++c) {
    const int x = l.x_of(c), y = l.y_of(c), half = h / 2;
    if (x % h != 0 || y % h != 0) continue;
    std::array<int, 4> corner, middle;  // vertices at the corners and in the middle of the sides
    int centre = 0;
    for (int k = 0; k < 4; ++k) {
      const auto side = sides(l, {l.face_of(c), x + (k % 3 > 0) * half, y + (k > 1) * half, half, half});
      corner[k] = side[k].vertex, middle[k] = side[(k + 1) % 4].vertex, centre = side[(k + 2) % 4].vertex;
    }
    const Eigen::RowVector3d face = net(corner, Eigen::all).colwise().mean();
    fine.row(centre) = face;
    for (int k = 0; k < 4; ++k) {
      const auto before = net.row(corner[(k + 3) % 4]), at = net.row(corner[k]), after = net.row(corner[(k + 1) % 4]);
      const int n = l.valence(corner[k]);
      fine.row(middle[k]) += ((at + after) / 2 + face) / 4;
      fine.row(corner[k]) += (face + (before + after) / 2 + (n - 2) * at) / (n * n);
    }
  }
  return fine;
}

/// Returns points of the limit surface of the initial net at vertices of a mesh. The points are computed on a mesh of 3 x 3 elements per face with L
/// levels of subdivision. They are exact at the corners of the cube and at distances of at least 2^-L elements of this mesh from the corners. L is
/// the smallest number of levels, up to 5, for which all other vertices are that far from the corners.
Net limit_points(const spline::TMesh& mesh, const std::vector<int>& vertices) {
  const spline::Lattice& l = *mesh.lattice;
  int levels = 0;
  while (levels < 5 && 3 * std::ranges::min(mesh.spacing) << levels < l.units) ++levels;
  const spline::TMesh coarse = spline::cube(3, levels);
  const spline::Space space = spline::space(coarse, spline::ExtraordinaryRule::catmull_clark);
  const Net net = coarse_net(*coarse.lattice)(spline::anchors(coarse), Eigen::all);
  const spline::Locator locator(space);
  Net points(vertices.size(), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i) points.row(i) = value(space, net, locator(spline::place(l, vertices[i]))).transpose();
  return points;
}

}  // namespace

Net smooth_sphere(const spline::TMesh& mesh) {
  const spline::Lattice& l = *mesh.lattice;
  const std::vector<int> vertices = spline::anchors(mesh);
  const int level = subdivisions(mesh, static_cast<int>(vertices.size()));
  if (level < 0) return limit_points(mesh, vertices).rowwise().normalized();
  Net net = coarse_net(l);
  for (int k = 0; k < level; ++k) net = subdivided(l, l.units / (3 << k), net);
  return net(vertices, Eigen::all).rowwise().normalized();
}

Net unit_sphere(const spline::TMesh& mesh, const LeastSquaresFit& fit, int fits) {
  Net net = smooth_sphere(mesh);
  for (int k = 0; k < fits; ++k) net = fit.fit_image(net, [](const Vec3& x) -> Vec3 { return x.normalized(); });
  return net;
}

Vec3 red_cell(const Vec3& x) {
  const double r2 = x[0] * x[0] + x[1] * x[1];
  const auto [c0, c1, c2] = red_cell_profile;
  return {x[0], x[1], x[2] / 2 * (c0 + c1 * r2 + c2 * r2 * r2)};
}

namespace {

/// Returns the point of the unit sphere that red_cell() maps to `x`. If `x` is close to the red cell, the result is close to its point.
Vec3 sphere_of_red_cell(const Vec3& x) {
  const double r2 = x[0] * x[0] + x[1] * x[1];
  const auto [c0, c1, c2] = red_cell_profile;
  return Vec3(x[0], x[1], 2 * x[2] / (c0 + c1 * r2 + c2 * r2 * r2)).normalized();
}

/// Returns the linear map to the shape, relative to its centre, from the unit sphere or (for a red cell) from the red cell of unit radius.
Mat3 map_of(const ParticleShape& shape) {
  const Vec3 semi_axes = shape.semi_axes ? *shape.semi_axes : Vec3::Constant(shape.radius.value_or(1));
  return shape.rotation() * semi_axes.asDiagonal();
}

}  // namespace

Net resting_shape(const LeastSquaresFit& fit, const Net& unit_sphere, const ParticleShape& shape) {
  Net net = unit_sphere;
  if (shape.shape == "red cell") net = fit.fit_image(net, [](const Vec3& x) { return red_cell(x.normalized()); });
  else if (!shape.ellipsoidal()) throw std::logic_error("no resting shape is defined for Particle/shape " + shape.shape);
  net = net * map_of(shape).transpose();
  net.rowwise() += shape.center.transpose();
  return net;
}

Net fitted_again(const spline::Space& space, const Net& net, const ParticleShape& shape) {
  if (shape.shape == "file" || shape.shape == "cylinder") return net;
  const LeastSquaresFit fit(space);
  Net sphere = (net.rowwise() - shape.center.transpose()) * map_of(shape).inverse().transpose();
  if (shape.shape == "red cell") sphere = fit.fit_image(sphere, sphere_of_red_cell);
  else if (!shape.ellipsoidal()) throw std::logic_error("fitted_again() does not know Particle/shape " + shape.shape);
  for (int k = 0; k < 3; ++k) sphere = fit.fit_image(sphere, [](const Vec3& x) -> Vec3 { return x.normalized(); });
  return resting_shape(fit, sphere, shape);
}

Net placed_again(const Net& net, const ParticleShape& from, const ParticleShape& to) {
  const Mat3 one = map_of(from), other = map_of(to), map = one == other ? Mat3(Mat3::Identity()) : Mat3(other * one.inverse());
  return ((net.rowwise() - from.center.transpose()) * map.transpose()).rowwise() + to.center.transpose();
}

bool is_linear_image(const ParticleShape& from, const ParticleShape& to) {
  if (from.shape != to.shape) return false;
  if (from.ellipsoidal()) return true;
  if (from.shape == "red cell") return true;   // red_cell_profile is a ratio to the radius
  if (from.shape == "cylinder") return false;  // its length is the period of the domain, which does not change with the radius
  if (from.shape == "file") return false;      // surfaces of two files are not compared
  throw std::logic_error("is_linear_image() does not know Particle/shape " + from.shape);
}

Net resting_shape(const spline::Space& space, const spline::TMesh& mesh, const ParticleShape& shape) {
  const LeastSquaresFit fit(space);
  return resting_shape(fit, unit_sphere(mesh, fit), shape);
}

Net resting_shape(const spline::Space& space, const spline::PolarMesh& mesh, int axis, const ParticleShape& shape) {
  return resting_shape(LeastSquaresFit(space), unit_sphere(mesh, space, axis), shape);
}

Net imported_shape(const ParticleShape& shape) {
  const auto& [space, net] = *shape.imported;
  const Vec3 centroid = measures(space, net).centroid;
  return ((net.rowwise() - centroid.transpose()) * shape.rotation().transpose()).rowwise() + shape.center.transpose();
}

}  // namespace tanktread::surface
