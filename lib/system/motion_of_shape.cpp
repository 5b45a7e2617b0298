#include "system/motion_of_shape.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/small_matrices.hpp"

namespace tanktread::coupling {

namespace {
/// Returns the mean velocity U (6.4) of a drop from the fluid velocity v at its control points and b = dV/dx. `from_mean`: control points minus their
/// mean. Exact if the velocity is uniform.
Eigen::RowVector3d mean_motion(const Net& from_mean, const Net& b, const Net& v) {
  const Eigen::VectorXd outward = b.cwiseProduct(v).rowwise().sum();
  return 3 * outward.transpose() * from_mean / b.cwiseProduct(from_mean).sum();
}

/// Returns half the vorticity of v, averaged over the interior, from v at the control points and b = dV/dx. `from_mean`: control points minus their
/// mean. Exact for a rigid rotation.
Vec3 mean_rotation(const Net& from_mean, const Net& b, const Net& v) {
  const Mat3 volume = b.transpose() * from_mean, flux = b.transpose() * (v.rowwise() - v.colwise().mean());
  const Mat3 gradient = volume.partialPivLu().solve(flux).transpose();
  return axial_vector(gradient) / 2;
}

/// Returns the velocity of the points y in a rotation about the origin.
Net rotated(const Vec3& rotation, const Net& y) { return -y.rowwise().cross(rotation.transpose()); }

/// Returns the weight g (4.14) of an axis, divided by m. m is about 1.6 D^2, with the Taylor deformation D of the drop in the plane normal to the
/// axis.
double weight_of_axis(double m) {
  constexpr double elongated = 0.02;  // value of m at the Taylor deformation D = 0.11, from which on g = 1: the mesh turns with the shape of the drop
  const double t = m / elongated;
  return t < 1 ? t * (3 - 2 * t) / elongated : 1 / m;
}

/// Returns the angular velocity Omega_s (4.14) of a shape that moves with the velocity u at the sites y. The area weight of a site is |b|, with the
/// volume gradient b = dV/dx of its control point.
Vec3 rotation_of_shape(const Net& y, const Net& normals, const Net& b, const Net& u) {
  Mat3 moments = Mat3::Zero();
  Vec3 across = Vec3::Zero();
  double inertia = 0;
  for (Eigen::Index i = 0; i < y.rows(); ++i) {
    const double area = b.row(i).norm();
    const Vec3 n = normals.row(i).transpose(), arm = Vec3(y.row(i).transpose()).cross(n);
    moments += area * arm * arm.transpose();
    across += area * arm * u.row(i).dot(n);
    inertia += area * y.row(i).squaredNorm() * 2 / 3;
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(moments / inertia);
  Vec3 rotation = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = axes.eigenvectors().col(k);
    rotation += weight_of_axis(axes.eigenvalues()[k]) * axis.dot(across) / inertia * axis;
  }
  return rotation;
}

/// Returns an approximation of the centroid of a drop, computed from its control points x and b = dV/dx: the centroid of one cone per control
/// point, with its apex at the mean of all control points and the volume b.y/3, where y is the position relative to this mean.
Eigen::RowVector3d approximate_centroid(const Net& x, const Net& b) {
  const Eigen::RowVector3d mean = x.colwise().mean();
  const Net y = x.rowwise() - mean;
  const Eigen::VectorXd volumes = b.cwiseProduct(y).rowwise().sum();
  return mean + 0.75 * volumes.transpose() * y / volumes.sum();
}

/// Returns the rate of stretch E (4.36) of a shape that moves with the velocity u at the sites y. The area weight of a site is |b|, see above.
Mat3 stretch_of_shape(const Net& y, const Net& normals, const Net& b, const Net& u) {
  const Eigen::VectorXd areas = b.rowwise().norm(), outward = areas.cwiseProduct(normals.cwiseProduct(u).rowwise().sum());
  const Eigen::VectorXd volumes = areas.cwiseProduct(normals.cwiseProduct(y).rowwise().sum());
  const Mat3 moments = y.transpose() * volumes.asDiagonal() * y / 5, change = y.transpose() * outward.asDiagonal() * y;
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(moments);
  const Vec3& m = axes.eigenvalues();
  const Mat3 sums = m.replicate<1, 3>() + m.transpose().replicate<3, 1>();
  const Mat3 stretch = axes.eigenvectors() * (axes.eigenvectors().transpose() * change * axes.eigenvectors()).cwiseQuotient(sums) *
                       axes.eigenvectors().transpose();
  return stretch - stretch.trace() / 3 * Mat3::Identity();
}

}  // namespace

MotionOfShape motion_of_shape(const DropSamples& drop, SharedMotion shared) {
  const Eigen::RowVector3d centre = approximate_centroid(drop.x, drop.b);
  const Net from_centre = drop.x.rowwise() - centre, y = drop.sites.rowwise() - centre;
  const Vec3 of_fluid = mean_rotation(from_centre, drop.b, drop.v);
  const Eigen::RowVector3d mean = mean_motion(from_centre, drop.b, drop.v - rotated(of_fluid, from_centre));
  MotionOfShape shape{centre.transpose(), mean.transpose(), Mat3::Zero()};
  if (shared == SharedMotion::translation) return shape;
  const Vec3 rotation = rotation_of_shape(y, drop.normals, drop.b, drop.velocities.rowwise() - mean);
  if (shared == SharedMotion::stretching)
    shape.gradient = stretch_of_shape(y, drop.normals, drop.b, (drop.velocities.rowwise() - mean) - rotated(rotation, y));
  for (int k = 0; k < 3; ++k) shape.gradient.col(k) += rotation.cross(Vec3::Unit(k));
  return shape;
}

}  // namespace tanktread::coupling
