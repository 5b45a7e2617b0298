#include "scene/flow_plane.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>

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
  if (contains_flow) return "in the plane " + plane;
  return "in the plane of the longest and the shortest axis, because the flow is not planar; tank-treading in the plane " + plane;
}

FlowPlane plane_normal_to(Vec3 normal) {
  normal.normalize();
  for (double& component : normal)
    if (std::abs(component) < 1e-12) component = 0;  // removes round-off, so that normals along a coordinate axis are exact
  const Vec3 first = std::abs(normal[0]) < 1 - 1e-9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 a = (first - normal * normal.dot(first)).normalized();
  Vec3 b = a.cross(normal).normalized();
  Eigen::Index largest;
  b.cwiseAbs().maxCoeff(&largest);
  if (b[largest] < 0) b = -b;
  FlowPlane plane;
  plane.axes << a.transpose(), b.cross(a).transpose(), b.transpose();
  plane.axes.array() += 0.0;  // removes negative zeros
  return plane;
}

std::optional<Mat3> axes_of_shear(const Mat3& gradient) {
  constexpr double most = 1e-6;  // relative rounding error of a gradient in a deck, above which the flow is no simple shear
  const Eigen::JacobiSVD<Mat3> parts(gradient, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3 along = parts.matrixU().col(0), across = parts.matrixV().col(0), sizes = parts.singularValues();
  if (!(sizes[0] > 0) || sizes[1] > most * sizes[0] || std::abs(along.dot(across)) > most) return {};
  Mat3 axes;
  axes << along.transpose(), along.cross(across).transpose(), across.transpose();
  return axes;
}

FlowPlane flow_plane(const stokes::FlowOptions& flow) {
  if (flow.type != "linear" || flow.gradient->isZero(0)) return {};
  const Mat3& l = *flow.gradient;
  // Matrix of the quadratic form |L n|^2 + |L^T n|^2 of a unit vector n, where L is the velocity gradient. The form is zero if the velocity has no
  // component along n and does not change along n.
  const Eigen::SelfAdjointEigenSolver<Mat3> varies(l.transpose() * l + l * l.transpose());
  const Vec3 values = varies.eigenvalues();
  if (values[0] < 1e-12 * values[2]) {
    FlowPlane plane = plane_normal_to(varies.eigenvectors().col(0));
    plane.of_shear = axes_of_shear(l);
    return plane;
  }
  const Vec3 vorticity = axial_vector(l);
  FlowPlane plane = vorticity.norm() > 1e-10 * l.norm() ? plane_normal_to(vorticity) : FlowPlane();
  plane.contains_flow = false;
  return plane;
}

}  // namespace tanktread
