#include "system/solids/bodies/rigid_body.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace tanktread::coupling {

namespace {

constexpr int affine_modes = 11, quadratic_modes = 18;

/// Indices of a quadratic velocity field y_b y_c e_i: the component i, and the coordinates b <= c (y: position from the centre).
struct UnitQuadratic {
  int i, b, c;
};
UnitQuadratic unit_quadratic(int k) {
  constexpr int first[] = {0, 0, 0, 1, 1, 2}, second[] = {0, 1, 2, 1, 2, 2};
  return {k / 6, first[k % 6], second[k % 6]};
}

/// Returns the coefficients c of a trace-free symmetric matrix e = sum_k c_k unit_strain(k).
Eigen::Matrix<double, 5, 1> strain_components(const Mat3& e) {
  Eigen::Matrix<double, 5, 1> c;
  c << e(0, 0), e(0, 0) + e(1, 1), e(0, 1), e(0, 2), e(1, 2);
  return c;
}

constexpr BlockId place{0}, orientation{1};  // blocks of the states


}  // namespace

Mat3 unit_strain(int k) {
  Mat3 e = Mat3::Zero();
  if (k < 2) {
    e(k, k) = 1;
    e(k + 1, k + 1) = -1;
  } else {
    const int i = k == 4 ? 1 : 0, j = k == 2 ? 1 : 2;
    e(i, j) = e(j, i) = 1;
  }
  return e;
}

Mat3 strain_of_products(const Eigen::Matrix<double, 5, 1>& p) {
  Mat3 e;
  e << (2 * p[0] + p[1]) / 3, p[2] / 2, p[3] / 2,  //
      p[2] / 2, (p[1] - p[0]) / 3, p[4] / 2,       //
      p[3] / 2, p[4] / 2, -(p[0] + 2 * p[1]) / 3;
  return e;
}

RigidModes::RigidModes(RigidTractions& body, const Net& surface, const Vec3& centre, bool quadratic)
    : response(6, affine_modes + (quadratic ? quadratic_modes : 0)) {
  body.set_shape(surface, {&centre, 1});
  const Net& at = body.sites();
  const Net from_centre = at.rowwise() - centre.transpose();
  const auto field = [&](int k) -> Net {
    if (k < 6) return rigid_velocity(at, unit_motion(k), centre);
    if (k < affine_modes) return from_centre * unit_strain(k - 6);
    const UnitQuadratic q = unit_quadratic(k - affine_modes);
    Net u = Net::Zero(at.rows(), 3);
    u.col(q.i) = from_centre.col(q.b).cwiseProduct(from_centre.col(q.c));
    return u;
  };
  Eigen::MatrixXd velocities(at.size(), response.cols());
  for (int k = 0; k < velocities.cols(); ++k) velocities.col(k) = field(k).reshaped<Eigen::RowMajor>();
  const Eigen::MatrixXd densities = body.layer().solved(velocities);
  for (int k = 0; k < densities.cols(); ++k) {
    density.push_back(as_net(densities.col(k)));
    const SolvedBody found = body.integrals(0, density.back());
    response.col(k) << found.force, found.torque;
    stresslet.push_back(found.stresslet());
  }
}

State placed(const Vec3& centre) {
  State position(std::make_shared<Layout>(
      std::vector<Block>{{.name = "position", .on = 0, .rows = 1},
                         {.name = "orientation", .on = 0, .rows = 1, .components = 4, .parity = Parity::scalar}}));
  position(place) = centre.transpose();
  position(orientation)(0, 3) = 1;
  return position;
}

Vec3 centre_of(const State& position) { return position(place).transpose(); }

Eigen::Quaterniond orientation_of(const State& position) { return Eigen::Quaterniond(Eigen::Vector4d(position(orientation).transpose())); }

Mat3 rotation_of(const State& position) { return orientation_of(position).normalized().toRotationMatrix(); }

State LoneRigidBody::velocity(const State& position) {
  ++evaluations_;
  const RigidMotion now = motion(position);
  const Eigen::Quaterniond q = orientation_of(position);
  const Eigen::Quaterniond rate = Eigen::Quaterniond(0, now.angular_velocity[0], now.angular_velocity[1], now.angular_velocity[2]) * q;
  State slope(position.layout());
  slope(place) = now.velocity.transpose();
  slope(orientation) = 0.5 * rate.coeffs().transpose();
  return slope;
}

void LoneRigidBody::restore_constraints(State& position) { position(orientation) /= orientation_of(position).norm(); }

double LoneRigidBody::norm(const State& displacement) const {
  return std::hypot(displacement(place).norm() / radius_, 2 * displacement(orientation).norm());
}

Net LoneRigidBody::moved(const Net& x, const State& position) const {
  return ((x.rowwise() - centre_.transpose()) * rotation_of(position).transpose()).rowwise() + centre_of(position).transpose();
}

FreeBody::FreeBody(RigidTractions& body, const Net& surface, const Vec3& centre, double radius, const stokes::AmbientFlow& flow,
                   const RigidDrive& driven)
    : LoneRigidBody(surface, centre, radius, flow, driven), modes_(body, surface, centre, !flow.affine()) {
  mobility_ = modes_.response.leftCols<6>().inverse();
  drift_ = mobility_ * modes_.response.rightCols(modes_.response.cols() - 6);
}

/// Returns the amplitudes of the modes (RigidModes) of the disturbance velocity on the body, in body-fixed axes. These are the rigid motion relative
/// to the flow, the negative strain rate of the flow and, if the flow is quadratic, its negative quadratic coefficients.
Eigen::VectorXd FreeBody::amplitudes(const State& position) const {
  const Mat3 turn = rotation_of(position), l = turn.transpose() * flow_.gradient(centre_of(position)) * turn;
  Eigen::VectorXd a(modes_.response.cols());
  a.segment<5>(6) = -strain_components(0.5 * (l + l.transpose()));
  if (!flow_.affine()) {
    const Vec3 d = turn.transpose() * flow_.quadratic_direction();
    const Mat3 h = turn.transpose() * flow_.curvature() * turn;
    for (int k = 0; k < quadratic_modes; ++k) {
      const auto [i, b, c] = unit_quadratic(k);
      a[affine_modes + k] = -(b == c ? 1 : 2) * d[i] * h(b, c);
    }
  }
  Eigen::Matrix<double, 6, 1> driven;
  driven << turn.transpose() * driven_.force, turn.transpose() * driven_.torque;
  a.head<6>() = mobility_ * driven - drift_ * a.tail(a.size() - 6);
  return a;
}

RigidMotion FreeBody::motion(const State& position) const {
  const Eigen::VectorXd a = amplitudes(position);
  const Mat3 turn = rotation_of(position);
  const Vec3 centre = centre_of(position);
  return {flow_.velocity(centre) + turn * a.segment<3>(0), 0.5 * axial_vector(flow_.gradient(centre)) + turn * a.segment<3>(3)};
}

Net FreeBody::force_density(const State& position) const {
  const Eigen::VectorXd a = amplitudes(position);
  Net f = Net::Zero(surface_.rows(), 3);
  for (Eigen::Index k = 0; k < a.size(); ++k) f += a[k] * modes_.density[static_cast<size_t>(k)];
  return f * rotation_of(position).transpose();
}

Mat3 FreeBody::stresslet(const State& position) const {
  const Eigen::VectorXd a = amplitudes(position);
  Mat3 s = Mat3::Zero();
  for (Eigen::Index k = 0; k < a.size(); ++k) s -= a[k] * modes_.stresslet[static_cast<size_t>(k)];
  const Mat3 turn = rotation_of(position);
  return turn * s * turn.transpose();
}

}  // namespace tanktread::coupling
