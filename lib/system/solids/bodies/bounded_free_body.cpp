#include "system/solids/bodies/bounded_free_body.hpp"

#include <limits>
#include <numbers>

#include <Eigen/LU>

#include "system/solids/ducts/duct.hpp"

namespace tanktread::coupling {

const BoundedFreeBody::Solution& BoundedFreeBody::solution(const State& position) const {
  if (position == position_) return solution_;
  position_ = {};  // invalidates the cached solution, also if the solve throws
  solution_ = solve(position);
  ++solves_;
  position_ = position;
  return solution_;
}

BoundedFreeBody::Solution BoundedFreeBody::outside_fluid(const Net& x) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return {{Vec3::Constant(nan), Vec3::Constant(nan)}, not_a_number(x), Mat3::Constant(nan)};
}

BoundedFreeBody::Solution FreeBodyInMedium::solve(const State& position) const {
  const Net x = surface(position);
  if (!body_.inside(x)) return outside_fluid(x);
  const Vec3 centre = centre_of(position);
  const RigidTractions::Solution& solution = body_.solve(x, {&centre, 1}, {&driven_, 1}, flow_);
  const SolvedBody& found = solution.bodies.front();
  return {found.motion, solution.unknowns, -found.stresslet()};
}

FreeBodyInTube::FreeBodyInTube(RigidTractions& body, const Net& surface, const Vec3& centre, double radius, const stokes::AmbientFlow& flow,
                               double viscosity, const RigidDrive& driven)
    : BoundedFreeBody(body, surface, centre, radius, flow, driven), viscosity_(viscosity), modes_(body, surface, centre, false) {}

/// Returns the solution. If the pressure drop of the duct is prescribed, the correction of the disturbed pressure drop changes the flow rate, too.
BoundedFreeBody::Solution FreeBodyInTube::solve(const State& position) const {
  const Net x = surface(position);
  if (!body_.inside(x)) return outside_fluid(x);
  const Solution found = in_body_axes(position, 0);
  if (body_.tube()->duct().flow_rate_reduction(1) == 0) return found;
  return in_body_axes(position, body_.tube()->duct().flow_rate_reduction(pressure_correction(position, found)));
}

/// Returns the correction (2.41) of the pressure drop due to the body for collocation errors: the integral of the residual velocity times the density
/// z due to the flow of the empty duct at a prescribed flow rate. For a body without forces in this flow, -f takes the place of z, and no further
/// solve is needed. If the pressure drop is prescribed, -f or z results from the flow that the pressure drop due to the body leaves, and is divided
/// by it.
double FreeBodyInTube::pressure_correction(const State& position, const Solution& found) const {
  Tube& tube = *body_.tube();
  const Net x = surface(position);
  const Net& f = found.density;
  const bool carried = flow_.duct() && flow_.amplitude() != 0 && driven_.force.isZero(0) && driven_.torque.isZero(0);
  const Net z = carried ? Net(-f) : density_at_rest(position, tube.flow().velocities(moved(body_.sites(), position)));
  const double amplitude = (carried ? flow_.amplitude() - found.slower : 1) - tube.duct().flow_rate_reduction(tube.pressure_of(z));
  return body_.pressure_correction_of(x, f, rigid_velocity(x, found.motion, centre_of(position)), flow_, found.slower, z / amplitude);
}

double FreeBodyInTube::pressure_drop(const State& position) const {
  const Solution& found = solution(position);
  if (!found.motion.velocity.allFinite()) return found.motion.velocity[0];  // outside of the fluid
  body_.tube()->set_shape(surface(position));
  return pressure_correction(position, found) - body_.tube()->pressure_of(found.density);
}

/// Returns the force density on the body at rest at `position` in the tube, which causes the given velocities at its sites.
Net FreeBodyInTube::density_at_rest(const State& position, const Net& velocities) const {
  const Mat3 turn = rotation_of(position);
  const Eigen::Index n = 3 * surface_.rows();
  const Apply apply = on_nets(n / 3, [&](const Net& f) { return body_.caused(-f, turn); });
  Eigen::VectorXd right(n), z = Eigen::VectorXd::Zero(n);
  Eigen::Map<Net>(right.data(), n / 3, 3) = velocities * turn;
  iterations_ += body_.solve_iteratively({one_block("traction", n), apply, body_.layer().preconditioner()}, right, z);
  ++solves_;
  return as_net(z) * turn.transpose();
}

/// Solves for the force density f and the motion U, Omega. The unknowns are scaled to velocities: f R_C/mu, U and Omega R_C. The force balance is
/// divided by 6 pi mu R_C and the torque balance by 6 pi mu R_C^2, so that their residuals are velocities too. `slower`: see Solution.
BoundedFreeBody::Solution FreeBodyInTube::in_body_axes(const State& position, double slower) const {
  using Six = Eigen::Matrix<double, 6, 1>;
  const Mat3 turn = rotation_of(position);
  const Eigen::Index n = surface_.rows();
  const double unit = viscosity_ / radius_, force_unit = 6 * std::numbers::pi * viscosity_ * radius_;
  Six of_motion, of_force;  // units by which (U, Omega) and (force, torque) are scaled
  of_motion << Vec3::Ones(), Vec3::Constant(1 / radius_);
  of_force << Vec3::Constant(force_unit), Vec3::Constant(force_unit * radius_);
  const auto motion_of = [](const Six& m) { return RigidMotion{m.head<3>(), m.tail<3>()}; };
  const auto balance = [&](const Net& f) {
    const SolvedBody found = body_.integrals(0, f);
    return (Six() << found.force, found.torque).finished();
  };
  const auto apply = [&](const double* in, double* out) {
    const Net f = unit * Eigen::Map<const Net>(in, n, 3);
    const Six motion = Eigen::Map<const Six>(in + 3 * n).cwiseProduct(of_motion);
    Eigen::Map<Net>(out, n, 3) = body_.caused(-f, turn) - rigid_velocity(body_.sites(), motion_of(motion), centre_);
    Eigen::Map<Six>(out + 3 * n) = balance(f).cwiseQuotient(of_force);
  };
  const auto precondition = [&](const double* in, double* out) {
    const Eigen::MatrixXd solved = body_.layer().solved(Eigen::Map<const Eigen::VectorXd>(in, 3 * n));
    Net f = as_net(solved.col(0));
    const Six missing = Eigen::Map<const Six>(in + 3 * n).cwiseProduct(of_force) - balance(f);
    const Six motion = modes_.response.leftCols<6>().partialPivLu().solve(missing);
    for (int k = 0; k < 6; ++k) f += motion[k] * modes_.density[static_cast<std::size_t>(k)];
    Eigen::Map<Net>(out, n, 3) = f / unit;
    Eigen::Map<Six>(out + 3 * n) = motion.cwiseQuotient(of_motion);
  };
  Eigen::VectorXd right(3 * n + 6);
  const Net at = moved(body_.sites(), position);
  Net flow = flow_.velocities(at);
  if (slower != 0) flow -= slower * body_.tube()->flow().velocities(at);
  Eigen::Map<Net>(right.data(), n, 3) = -flow * turn;
  right.tail<6>() << turn.transpose() * driven_.force / force_unit, turn.transpose() * driven_.torque / (force_unit * radius_);
  if (unknowns_.size() != right.size()) unknowns_ = Eigen::VectorXd::Zero(right.size());
  iterations_ += body_.solve_iteratively({{{.name = "traction", .rows = n}, {.name = "rigid motion", .rows = 2}}, apply, precondition}, right,
                                         unknowns_);
  const Net f = unit * as_net(unknowns_.head(3 * n));
  const RigidMotion motion = motion_of(Six(unknowns_.tail<6>()).cwiseProduct(of_motion));
  return {{turn * motion.velocity, turn * motion.angular_velocity}, f * turn.transpose(),
          -turn * body_.integrals(0, f).stresslet() * turn.transpose(), slower};
}

}  // namespace tanktread::coupling
