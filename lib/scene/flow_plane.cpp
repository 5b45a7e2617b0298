#include "scene/flow_plane.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "base/formatted.hpp"

namespace tanktread {

namespace {

std::string direction(const Vec3& v) {
  for (int c = 0; c < 3; ++c)
    if (v == Vec3::Unit(c)) return "x" + std::to_string(c + 1);
  return formatted("(%.4g, %.4g, %.4g)", v[0], v[1], v[2]);
}

}  // namespace

std::string FlowPlane::description() const {
  const std::string plane = direction(axes.row(0)) + " " + direction(axes.row(2));
  if (holds_flow) return "in the plane " + plane;
  return "in the plane of the longest and the shortest axis, for the flow is not planar; tank-treading in the plane " + plane;
}

FlowPlane plane_normal_to(Vec3 normal) {
  normal.normalize();
  for (double& component : normal)
    if (std::abs(component) < 1e-12) component = 0;  // so that planes through two axes of space are exact
  const Vec3 first = std::abs(normal[0]) < 1 - 1e-9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 a = (first - normal * normal.dot(first)).normalized();
  Vec3 b = a.cross(normal).normalized();
  Eigen::Index largest;
  b.cwiseAbs().maxCoeff(&largest);
  if (b[largest] < 0) b = -b;
  FlowPlane plane;
  plane.axes << a.transpose(), b.cross(a).transpose(), b.transpose();
  plane.axes.array() += 0.0;  // no negative zeros
  return plane;
}

FlowPlane flow_plane(const stokes::FlowOptions& flow) {
  if (flow.type != "linear" || flow.gradient->isZero(0)) return {};
  const Mat3& l = *flow.gradient;
  const Eigen::SelfAdjointEigenSolver<Mat3> varies(l.transpose() * l + l * l.transpose());  // along n: |L n|^2 + |L^T n|^2
  const Vec3 values = varies.eigenvalues();
  if (values[0] < 1e-12 * values[2]) return plane_normal_to(varies.eigenvectors().col(0));
  const Vec3 vorticity(l(2, 1) - l(1, 2), l(0, 2) - l(2, 0), l(1, 0) - l(0, 1));
  FlowPlane plane = vorticity.norm() > 1e-10 * l.norm() ? plane_normal_to(vorticity) : FlowPlane();
  plane.holds_flow = false;
  return plane;
}

}  // namespace tanktread
