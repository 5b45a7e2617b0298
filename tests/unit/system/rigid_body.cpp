// Tests of free rigid bodies in affine flows: Jeffery's motion, and properties of every free body.

#include <cmath>
#include <memory>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "single_ellipsoid.hpp"
#include "surface/geometry.hpp"
#include "system/solids/bodies/bounded_free_body.hpp"

namespace tanktread::coupling {
namespace rigid_body_test {

using std::numbers::pi;
constexpr double viscosity = SingleEllipsoid::viscosity;

Mat3 some_gradient() {
  Mat3 l;
  l << 0.5, 0.3, 1.0, -0.4, 0.2, 0.6, 0.1, -0.8, -0.7;
  return l;
}

/// A free body in the linear flow above.
struct Fixture : SingleEllipsoid {
  std::unique_ptr<FreeBody> body;

  explicit Fixture(const Vec3& semi_axes) : SingleEllipsoid(semi_axes, Vec3(0.3, -0.1, 0.2)) {
    stokes::FlowOptions flow;
    flow.type = "linear";
    flow.gradient = some_gradient();
    body = std::make_unique<FreeBody>(*tractions, rest, shape.center, shape.equivalent_radius(), stokes::AmbientFlow(flow));
  }

  State turned(double angle, const Vec3& axis) const {
    State place = placed(shape.center);
    place(BlockId{1}) = Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized())).coeffs().transpose();
    return place;
  }
};

TEST(FreeBody, SphereMovesWithTheFlow) {
  const Fixture f(Vec3::Constant(0.8));
  const RigidMotion motion = f.body->motion(f.turned(0.7, Vec3(1, 2, 3)));
  const Mat3 l = some_gradient();
  EXPECT_LT((motion.velocity - l * f.shape.center).norm(), 1e-9);  // the mesh is symmetric, and the system is factored
  EXPECT_LT((motion.angular_velocity - 0.5 * Vec3(l(2, 1) - l(1, 2), l(0, 2) - l(2, 0), l(1, 0) - l(0, 1))).norm(), 1e-9);
  const Mat3 strain = 0.5 * (l + l.transpose()), exact = 20 * pi / 3 * viscosity * 0.8 * 0.8 * 0.8 * strain;  // Einstein 1906
  EXPECT_LT((f.body->stresslet(placed(f.shape.center)) - exact).norm() / exact.norm(), 5e-5);  // fourth order: 2.4e-5
}

TEST(FreeBody, SpheroidRotatesAsByJeffery) {
  const double ratio = 1.6, b = (ratio * ratio - 1) / (ratio * ratio + 1);
  const Fixture f(Vec3(0.7, 0.7, 0.7 * ratio));
  const Mat3 l = some_gradient(), e = 0.5 * (l + l.transpose()), w = 0.5 * (l - l.transpose());
  for (const State& place : {placed(f.shape.center), f.turned(0.7, Vec3(1, 2, 3)), f.turned(2.5, Vec3(0, 1, -1))}) {
    const Vec3 p = rotation_of(place) * Vec3(0, 0, 1);
    const Vec3 exact = w * p + b * (e * p - p * p.dot(e * p));
    EXPECT_LT((f.body->motion(place).angular_velocity.cross(p) - exact).norm(), 1e-5);  // error of the fitted surface with six elements per side
  }
}

stokes::FlowOptions parabolic() {
  stokes::FlowOptions flow;
  flow.type = "parabolic", flow.profile = "round", flow.maximum_velocity = 2, flow.half_width = 1.6;
  return flow;
}

TEST(FreeBody, SphereInParabolicFlowMovesAsByFaxen) {
  const Fixture f(Vec3::Constant(0.8));
  const stokes::AmbientFlow flow(parabolic());
  const FreeBody body(*f.tractions, f.rest, f.shape.center, 0.8, flow);
  const RigidMotion motion = body.motion(f.turned(0.7, Vec3(1, 2, 3)));
  const Vec3 c = f.shape.center, laplacian(2 * flow.curvature().trace(), 0, 0);
  const Mat3 l = flow.gradient(c);
  EXPECT_LT((motion.velocity - flow.velocity(c) - 0.64 / 6 * laplacian).norm() / motion.velocity.norm(), 2e-5);  // error of the mesh of six elements
                                                                                                                 // per side
  EXPECT_LT((motion.angular_velocity - 0.5 * Vec3(l(2, 1) - l(1, 2), l(0, 2) - l(2, 0), l(1, 0) - l(0, 1))).norm(), 1e-5);
}

// At one position the combination of modes must equal a direct solve for the same motion. FreeBodyInMedium also solves for the motion; it corrects
// the collocation errors of force and torque (2.11), which the modes do not.
TEST(FreeBody, InAQuadraticFlowModesAgreeWithADirectSolve) {
  Fixture f(Vec3(0.7, 0.9, 1.2));
  stokes::FlowOptions options = parabolic();
  options.history.emplace();
  options.history->times = {0, 2}, options.history->amplitudes = {1, 3}, options.history->angles = {0, 60}, options.history->axis = "x3";
  const stokes::AmbientFlow flow(options);
  FreeBody modes(*f.tractions, f.rest, f.shape.center, 0.9, flow);
  FreeBodyInMedium solve(*f.tractions, f.rest, f.shape.center, 0.9, flow);
  const State place = f.turned(1.1, Vec3(1, -1, 0.5));
  for (const double time : {0.0, 1.0}) {
    modes.set_time(time, 0);
    solve.set_time(time, 0);
    const RigidMotion one = modes.motion(place), other = solve.motion(place);
    EXPECT_LT((one.velocity - other.velocity).norm(), 2e-5 * other.velocity.norm());
    EXPECT_LT((one.angular_velocity - other.angular_velocity).norm(), 5e-5 * other.angular_velocity.norm());
    EXPECT_LT((modes.stresslet(place) - solve.stresslet(place)).norm(), 1e-4 * solve.stresslet(place).norm());
    const Vec3 centre = centre_of(place);
    f.tractions->set_shape(modes.surface(place), {&centre, 1});
    const Net& at = f.tractions->sites();
    const Net direct = f.tractions->density(rigid_velocity(at, one, centre) - modes.flow().velocities(at));
    EXPECT_LT((modes.force_density(place) - direct).norm(), 1e-6 * direct.norm());  // tolerance of integrals times the condition number
    EXPECT_LT((modes.stresslet(place) + f.tractions->integrals(0, direct).stresslet()).norm(), 1e-6 * modes.stresslet(place).norm());
  }
}

TEST(FreeBody, IsFreeOfForceAndTorque) {
  const Fixture f(Vec3(0.7, 0.9, 1.2));
  const Net f0 = f.body->force_density(placed(f.shape.center));
  const double scale = viscosity * some_gradient().norm();
  const SolvedBody found = f.tractions->integrals(0, f0);
  EXPECT_LT(found.force.norm(), 1e-9 * scale);  // round-off, times condition numbers of 1e2
  EXPECT_LT(found.torque.norm(), 1e-9 * scale);
}

TEST(FreeBody, MovesAsItsSurfaceDoes) {
  Fixture f(Vec3(0.7, 0.9, 1.2));
  const State place = f.turned(1.1, Vec3(1, -1, 0.5));
  const RigidMotion motion = f.body->motion(place);
  const double h = 1e-5;
  const State slope = f.body->velocity(place);
  const Net rate = (f.body->surface(place + h * slope) - f.body->surface(place - h * slope)) / (2 * h);
  const Net exact = rigid_velocity(f.body->surface(place), motion, centre_of(place));
  EXPECT_LT((rate - exact).norm() / exact.norm(), 1e-8);  // truncation error h^2, and round-off divided by h
}

TEST(FreeBody, KeepsItsQuaternionNormalised) {
  Fixture f(Vec3(0.7, 0.9, 1.2));
  State place = f.turned(1.1, Vec3(1, -1, 0.5));
  const Mat3 before = rotation_of(place);
  place(BlockId{1}) *= 1.3;
  EXPECT_LT((rotation_of(place) - before).norm(), 1e-15);
  f.body->restore_constraints(place);
  EXPECT_NEAR(place(BlockId{1}).norm(), 1, 1e-15);
}

}  // namespace rigid_body_test
}  // namespace tanktread::coupling
