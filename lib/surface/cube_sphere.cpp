#include "surface/cube_sphere.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tanktread::surface {
namespace {

/// The net of the face x3 = 1 with one ring of mirror images around it.
struct FaceNet {
  int n;
  Net points;

  explicit FaceNet(int elements) : n(elements), points(Net::Zero((elements + 3) * (elements + 3), 3)) {}
  Vec3 at(int i, int j) const { return points.row((j + 1) * (n + 3) + i + 1).transpose(); }
  void set(int i, int j, const Vec3& x) { points.row((j + 1) * (n + 3) + i + 1) = x.transpose(); }

  /// Fills the ring: mirrors in the planes x1 = -+x3 and x2 = -+x3. The four outermost corners do not exist on the cube; each is set so that the
  /// corner element closes with a parallelogram.
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

/// Catmull-Clark rule (Q + 2 R + (N - 3) P)/N: Q mean of the face points, R of the edges' middles.
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

/// Weighted mean of the 4 x 4 vertices around the cell of a point on the cube. Permuting two axes and turning a sign carries its face onto x3 = 1
/// and the result back.
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
