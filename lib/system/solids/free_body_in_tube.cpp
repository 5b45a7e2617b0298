#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/LU>

#include "system/solids/rigid_body.hpp"

namespace tanktread::coupling {

FreeBodyInTube::FreeBodyInTube(Resistance& body, const Vec3& centre, double radius, const stokes::AmbientFlow& flow, double viscosity,
                               const SolverOptions& solvers, const Rigid& driven)
    : LoneRigidBody(body.surface(), centre, radius, flow, driven),
      body_(body),
      viscosity_(viscosity),
      krylov_(solvers.of(solvers.traction)),
      tolerance_(solvers.tolerance),
      unknowns_(Eigen::VectorXd::Zero(body.surface().size() + 6)) {}

/// Returns the motion, force density and stresslet of the body at the position `place`. Linear systems are solved in body-fixed axes.
const FreeBodyInTube::Solution& FreeBodyInTube::solution(const Net& place) const {
  if (place_.size() > 0 && place == place_) return solution_;
  const Mat3 turn = rotation_of(place);
  body_.place(surface(place), turn);
  if (!body_.inside()) {
    place_ = place;
    solution_.motion = {Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), Vec3::Zero()};
    return solution_;
  }
  if (body_.wall()) {
    Net f;
    RigidMotion own;
    solve_beside_wall(place, f, own);
    keep(place, f, own);
  } else {
    solve_in_tube(place);
    keep(place, density_of_unknowns(), motion_of_unknowns());
  }
  return solution_;
}

void FreeBodyInTube::keep(const Net& place, const Net& f, const RigidMotion& own) const {
  const Mat3 turn = rotation_of(place);
  place_ = place;
  solution_.motion = {turn * own.velocity, turn * own.angular_velocity};
  solution_.density = f * turn.transpose();
  solution_.stresslet = -turn * body_.stresslet(f, centre_) * turn.transpose();
}

void FreeBodyInTube::start_from(const Start& start) {
  if (body_.wall() || start.place.size() == 0) return;
  unknowns_ = start.unknowns;
  body_.place(surface(start.place), rotation_of(start.place));
  keep(start.place, density_of_unknowns(), motion_of_unknowns());
}

void FreeBodyInTube::forget_recycled() const {
  krylov_.forget();
  body_.forget_recycled();
}

double FreeBodyInTube::pressure_drop(const Net& place) const {
  const Net f = solution(place).density * rotation_of(place);
  return body_.pressure_drop(f) + body_.lacking_pressure(flow_, f);
}

Net FreeBodyInTube::density_of_unknowns() const {
  return viscosity_ / radius_ * Eigen::Map<const Net>(unknowns_.data(), surface_.rows(), 3);
}

RigidMotion FreeBodyInTube::motion_of_unknowns() const {
  const auto motion = unknowns_.tail<6>();
  return {motion.head<3>(), motion.tail<3>() / radius_};
}

/// Solves for the force density f and the motion U, Omega. The unknowns are scaled to velocities: f R_C/mu, U and Omega R_C. The force balance is
/// divided by 6 pi mu R_C and the torque balance by 6 pi mu R_C^2, so that their residuals are velocities too.
void FreeBodyInTube::solve_in_tube(const Net& place) const {
  const Mat3 turn = rotation_of(place);
  const Eigen::Index n = surface_.rows();
  const double unit = viscosity_ / radius_, force_unit = 6 * std::numbers::pi * viscosity_ * radius_;
  const auto motion_of = [&](const double* m) { return RigidMotion{Eigen::Map<const Vec3>(m), Eigen::Map<const Vec3>(m + 3) / radius_}; };
  const auto apply = [&](const double* in, double* out) {
    const Net of = unit * Eigen::Map<const Net>(in, n, 3);
    Eigen::Map<Net>(out, n, 3) = body_.velocity(of) - rigid_velocity(surface_, motion_of(in + 3 * n), centre_);
    Eigen::Map<Vec3>(out + 3 * n) = body_.force(of) / force_unit;
    Eigen::Map<Vec3>(out + 3 * n + 3) = body_.torque(of, centre_) / (force_unit * radius_);
  };
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(3 * n + 6);
  Eigen::Map<Net>(rhs.data(), n, 3) = -body_.ambient(flow_);
  rhs.tail<6>() << turn.transpose() * driven_.force / force_unit, turn.transpose() * driven_.torque / (force_unit * radius_);
  const SolveReport report = krylov_.solve({{{"traction", 3 * n}, {"rigid motion", 6}}, apply, {}}, rhs, unknowns_, tolerance_);
  iterations_ += report.iterations;
  require_convergence(report, "the traction and the motion of the free body in the tube", tolerance_);
}

/// Computes the traction f from the densities for the body at rest and for the six unit motions, so that force and torque have their prescribed
/// values. Then changes the motion and f once more, to correct the collocation errors of force and torque.
void FreeBodyInTube::solve_beside_wall(const Net& place, Net& f, RigidMotion& own) const {
  using Six = Eigen::Matrix<double, 6, 1>;
  const Mat3 turn = rotation_of(place);
  const auto integrals = [&](const Net& of) {
    Six both;
    both << body_.force(of), body_.torque(of, centre_);
    return both;
  };
  std::vector<Net> z;
  Eigen::Matrix<double, 6, 6> resistance;
  for (int k = 0; k < 6; ++k) {
    z.push_back(body_.force_density(rigid_velocity(surface_, unit_motion(k), centre_)));
    resistance.col(k) = integrals(z.back());
  }
  f = body_.force_density(-body_.ambient(flow_));
  const auto move = [&](const Six& missing) {
    const Six change = resistance.partialPivLu().solve(missing);
    for (int k = 0; k < 6; ++k) f += change[k] * z[static_cast<std::size_t>(k)];
    own.velocity += change.head<3>();
    own.angular_velocity += change.tail<3>();
  };
  Six given;
  given << turn.transpose() * driven_.force, turn.transpose() * driven_.torque;
  move(given - integrals(f));
  const auto relative = [&](const Net& x) -> Net {
    const Net in_space = ((x.rowwise() - centre_.transpose()) * turn.transpose()).rowwise() + place.row(0);
    return rigid_velocity(x, own, centre_) - flow_.velocities(in_space) * turn;
  };
  move(-body_.residual_work(relative, f, z));
}

}  // namespace tanktread::coupling
