#include "surface/shapes.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "surface/geometry.hpp"

namespace tanktread::surface {

namespace {

/// Returns k if the mesh is uniform with 3 * 2^k elements per side of the cube, otherwise -1.
int subdivisions(const spline::TMesh& mesh, int n_points) {
  int level = 0, n = 3;
  while (6 * n * n + 2 < n_points) n *= 2, ++level;
  return 6 * n * n + 2 == n_points && mesh.lattice->units % n == 0 ? level : -1;
}

/// Returns initial control points of the sphere: vertices of the subdivided net itself if the mesh is uniform with 3 * 2^k elements per side,
/// otherwise points of the limit surface.
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
  const auto [c0, c1, c2] = red_cell_profile;
  return {x[0], x[1], x[2] / 2 * (c0 + c1 * r2 + c2 * r2 * r2)};
}

namespace {

/// Returns the linear map from the unit sphere, or the red cell of unit radius, to the shape about its centre.
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

Net placed_again(const Net& net, const ParticleShape& from, const ParticleShape& to) {
  const Mat3 one = map_of(from), other = map_of(to), map = one == other ? Mat3(Mat3::Identity()) : Mat3(other * one.inverse());
  return ((net.rowwise() - from.center.transpose()) * map.transpose()).rowwise() + to.center.transpose();
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

namespace {

/// The vertices of the cube's face x3 = 1 with one ring of mirror images of vertices around it.
struct FaceNet {
  int n;
  Net points;

  explicit FaceNet(int elements) : n(elements), points(Net::Zero((elements + 3) * (elements + 3), 3)) {}
  Vec3 at(int i, int j) const { return points.row((j + 1) * (n + 3) + i + 1).transpose(); }
  void set(int i, int j, const Vec3& x) { points.row((j + 1) * (n + 3) + i + 1) = x.transpose(); }

  /// Fills the ring around the face with mirror images of vertices in the planes x1 = -+x3 and x2 = -+x3. The four outermost corners do not exist
  /// on the cube. Each is set so that the corner element becomes a parallelogram.
  void mirror() {
    for (int k = 0; k <= n; ++k) {
      set(-1, k, mirrored(at(1, k), 0, -1));
      set(n + 1, k, mirrored(at(n - 1, k), 0, 1));
      set(k, -1, mirrored(at(k, 1), 1, -1));
      set(k, n + 1, mirrored(at(k, n - 1), 1, 1));
    }
    for (const int i : {0, n})
      for (const int j : {0, n}) {
        const int i1 = i == 0 ? -1 : n + 1, j1 = j == 0 ? -1 : n + 1;
        set(i1, j1, at(i1, j) + at(i, j1) - at(i, j));
      }
  }
  static Vec3 mirrored(const Vec3& x, int axis, double sign) {
    Vec3 image = x;
    image[axis] = sign * x[2];
    image[2] = sign * x[axis];
    return image;
  }

  Vec3 centre_of_cell(int i, int j) const { return (at(i, j) + at(i + 1, j) + at(i, j + 1) + at(i + 1, j + 1)) / 4; }
};

FaceNet coarse_net() {
  constexpr double edge = 1. / 3, inner = 0.26;
  FaceNet net(3);
  for (int j = 0; j <= 3; ++j) {
    for (int i = 0; i <= 3; ++i) {
      const double near = i % 3 == 0 || j % 3 == 0 ? edge : inner;
      const double place[] = {-1, -near, near, 1};
      net.set(i, j, Vec3(place[i], place[j], 1).normalized());
    }
  }
  net.mirror();
  return net;
}

/// Applies the Catmull-Clark rule (Q + 2 R + (N - 3) P)/N, with P the vertex, N its valence, Q the mean of the adjacent face points and R the mean
/// of the midpoints of its edges.
Vec3 vertex_point(const FaceNet& net, int i, int j) {
  const bool corner = (i == 0 || i == net.n) && (j == 0 || j == net.n);
  const Vec3 p = net.at(i, j);
  Vec3 faces = Vec3::Zero(), ends = Vec3::Zero();
  if (corner) {
    const int in_i = i == 0 ? 0 : net.n - 1, out_i = i == 0 ? -1 : net.n, in_j = j == 0 ? 0 : net.n - 1, out_j = j == 0 ? -1 : net.n;
    const int next_i = i == 0 ? 1 : net.n - 1, next_j = j == 0 ? 1 : net.n - 1, beyond = i == 0 ? -1 : net.n + 1;
    faces = net.centre_of_cell(in_i, in_j) + net.centre_of_cell(out_i, in_j) + net.centre_of_cell(in_i, out_j);
    ends = net.at(next_i, j) + net.at(i, next_j) + net.at(beyond, j);
    return (faces / 3 + (p + ends / 3)) / 3;
  }
  for (const auto& [di, dj] : {std::pair{0, 0}, {-1, 0}, {0, -1}, {-1, -1}}) faces += net.centre_of_cell(i + di, j + dj);
  for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) ends += net.at(i + di, j + dj);
  return (faces / 4 + (p + ends / 4) + p) / 4;
}

FaceNet subdivided(const FaceNet& net) {
  FaceNet fine(2 * net.n);
  for (int j = 0; j <= net.n; ++j) {
    for (int i = 0; i <= net.n; ++i) {
      fine.set(2 * i, 2 * j, vertex_point(net, i, j));
      if (i < net.n)
        fine.set(2 * i + 1, 2 * j, (net.at(i, j) + net.at(i + 1, j) + net.centre_of_cell(i, j) + net.centre_of_cell(i, j - 1)) / 4);
      if (j < net.n)
        fine.set(2 * i, 2 * j + 1, (net.at(i, j) + net.at(i, j + 1) + net.centre_of_cell(i, j) + net.centre_of_cell(i - 1, j)) / 4);
      if (i < net.n && j < net.n) fine.set(2 * i + 1, 2 * j + 1, net.centre_of_cell(i, j));
    }
  }
  fine.mirror();
  return fine;
}

void uniform_b_spline(double x, double (&value)[4]) {
  const double y = 1 - x;
  value[0] = y * y * y / 6;
  value[1] = (3 * x * x * x - 6 * x * x + 4) / 6;
  value[2] = (3 * y * y * y - 6 * y * y + 4) / 6;
  value[3] = x * x * x / 6;
}

/// Returns the weighted mean of the 4 x 4 vertices around the cell that contains a point of the cube. The point is mapped to the face x3 = 1 by
/// swapping two axes and changing a sign, and the result is mapped back.
template <class Weights>
Vec3 radial_mean(const Vec3& on_cube, int n, const Net& net, Weights weights) {
  int axis;
  on_cube.cwiseAbs().maxCoeff(&axis);
  const double sign = on_cube[axis] < 0 ? -1 : 1;
  Vec3 turned = on_cube;
  std::swap(turned[axis], turned[2]);

  double weight[2][4];
  int cell[2];
  for (int d = 0; d < 2; ++d) {
    const double u = std::clamp((turned[d] + 1) / 2 * n, 0., double(n));
    cell[d] = std::min(static_cast<int>(u), n - 1);
    weights(u - cell[d], weight[d]);
  }
  Vec3 result = Vec3::Zero();
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) result += weight[0][i] * weight[1][j] * net.row((cell[1] + j) * (n + 3) + cell[0] + i).transpose();
  result[2] *= sign;
  std::swap(result[axis], result[2]);
  return result.normalized();
}

void linear(double x, double (&value)[4]) {
  value[0] = value[3] = 0;
  value[1] = 1 - x;
  value[2] = x;
}

}  // namespace

CubeSphere::CubeSphere(int levels) {
  FaceNet net = coarse_net();
  for (int level = 0; level < levels; ++level) net = subdivided(net);
  n_ = net.n;
  net_ = std::move(net.points);
}

Vec3 CubeSphere::net_point(const Vec3& on_cube) const { return radial_mean(on_cube, n_, net_, linear); }
Vec3 CubeSphere::limit_point(const Vec3& on_cube) const { return radial_mean(on_cube, n_, net_, uniform_b_spline); }

}  // namespace tanktread::surface
