// The response of a tube is linear, independent of the particle's position along the tube, and consistent with the block system, with its frozen copy
// and with its checks.

#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "quadrature/gauss.hpp"
#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "system/solids/ducts/duct.hpp"
#include "system/targets/collocation.hpp"
#include "system/solids/bodies/bounded_free_body.hpp"
#include "system/solids/ducts/tube.hpp"
#include "system/solids/shared_walls.hpp"

namespace tanktread::coupling {
namespace tube_test {

using std::numbers::pi;
constexpr double viscosity = 1.7;

void set_particle(Tube& tube, const spline::Space& space, const Net& unstressed, double ratio) {
  const Particle particle{.space = &space, .block = spline::whole(space), .viscosity_ratio = ratio};
  tube.set_particles(unstressed, {&particle, 1});
}

/// A sphere of radius 0.5 off the axis of a tube of radius 1, both with coarse meshes.
struct Fixture {
  spline::TMesh mesh = spline::cube(3);
  spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  Ranks ranks;
  Phases phases;
  surface::ParticleShape shape;
  Net x, f, v;
  std::shared_ptr<const stokes::DuctFlow> flow;
  TubeParameters parameters;
  std::unique_ptr<Tube> tube;

  explicit Fixture(double ratio) {
    shape.radius = 0.5;
    shape.center = Vec3(0, 0.1, -0.05);
    x = surface::resting_shape(space, mesh, shape);
    f = Net(x.rows(), 3), v = f;
    for (Eigen::Index i = 0; i < f.rows(); ++i) {
      f.row(i) << x(i, 1) * x(i, 1), x(i, 0), std::sin(3 * x(i, 2));
      v.row(i) << 1 + x(i, 2), x(i, 0) * x(i, 0), -x(i, 1);
    }
    surface::TubeOptions options;
    options.radius = 1;
    options.azimuthal_elements = 12, options.axial_elements = 10;
    flow = std::make_shared<stokes::DuctFlow>(options, viscosity, 1.3);
    parameters.viscosity = viscosity;
    parameters.quadrature.tolerance = 1e-6;
    parameters.walls = std::make_shared<SharedWalls>();
    tube = std::make_unique<Tube>(surface::tube_wall(flow->outline(), options, 2 * pi), *flow, space, parameters, phases);
    set_particle(*tube, space, x, ratio);
    tube->set_shape(x);
  }
};

TEST(Tube, HasALinearResponse) {
  Fixture s(5);
  const Tube::Response both = s.tube->respond(s.f, s.v), load = s.tube->respond(s.f), velocity = s.tube->respond({}, s.v);
  EXPECT_LT((both.velocity - load.velocity - velocity.velocity).norm() / both.velocity.norm(), 1e-12);
  EXPECT_LT((both.wall_traction - load.wall_traction - velocity.wall_traction).norm() / both.wall_traction.norm(), 1e-11);
  EXPECT_NEAR(both.pressure_drop, load.pressure_drop + velocity.pressure_drop, 1e-12 * std::abs(both.pressure_drop));
}

TEST(Tube, SolvesTheBlockSystem) {
  Fixture s(5);
  const Tube::Response r = s.tube->respond(s.f, s.v);
  EXPECT_LT(s.tube->duct().residual(r.wall_traction, r.pressure_drop, r.on_wall).norm() / r.on_wall.norm(), 1e-11);
  Tube::Response answer = r;
  answer.velocity.setZero();
  s.tube->add_answer(answer);
  EXPECT_LT((answer.velocity - r.velocity).norm() / r.velocity.norm(), 1e-12);
}

TEST(Tube, HasTheExactPressureDropOnAnyMeshOfTheSurface) {
  Fixture s(1);
  const Net along = Eigen::RowVector3d(1, 0, 0).replicate(s.x.rows(), 1);
  const auto& rule = quadrature::tensor_gauss(12);
  constexpr double h = 1e-4;
  double work = 0;  // work of this force in the tube's flow
  for (int e = 0; e < static_cast<int>(s.space.elements.size()); ++e)
    for (int q = 0; q < rule.size(); ++q) {
      const auto at = [&](double du, double dv) -> Vec3 { return surface::value(s.space, s.x, {e, rule.s[q] + du, rule.t[q] + dv}); };
      const double area = (at(h, 0) - at(-h, 0)).cross(at(0, h) - at(0, -h)).norm() / (4 * h * h);
      work += rule.weights[q] * area * s.flow->velocity(at(0, 0))[0];
    }
  EXPECT_NEAR(s.tube->pressure_of(along) * s.flow->flow_rate() / work, 1, 1e-7);  // finite differences with step h; the error would be 1.1e-4 if the
                                                                                  // flow were interpolated
}

TEST(Tube, IgnoresVelocitiesIfTheViscositiesAreEqual) {
  Fixture s(1);
  EXPECT_EQ((s.tube->respond(s.f, s.v).velocity - s.tube->respond(s.f).velocity).norm(), 0);
  EXPECT_EQ(s.tube->respond({}, s.v).pressure_drop, 0);
}

TEST(Tube, IsTheSameEverywhereAlongItsAxis) {
  Fixture s(5);
  const Net here = s.tube->respond(s.f, s.v).velocity;
  const double gap = s.tube->gap();
  s.tube->set_shape(s.x.rowwise() + Eigen::RowVector3d(123, 0, 0));
  EXPECT_LT((s.tube->respond(s.f, s.v).velocity - here).norm() / here.norm(), 1e-9);  // round-off at a distance of 123
  EXPECT_NEAR(s.tube->gap(), gap, 1e-10);
}

TEST(Tube, MeasuresTheGap) {
  Fixture s(1);
  EXPECT_NEAR(s.tube->gap(), 1 - 0.5 - std::hypot(0.1, 0.05), 2e-3);  // errors of the fitted sphere and circle
}

TEST(Tube, HasAFrozenResponse) {
  Fixture s(5);
  s.tube->freeze();
  const Net now = s.tube->respond(s.f, s.v).velocity;
  s.tube->set_shape(0.8 * s.x);
  EXPECT_LT((s.tube->frozen_response(s.f, s.v) - now).norm() / now.norm(), 1e-2);  // nine bits per entry
  EXPECT_GT((s.tube->respond(s.f, s.v).velocity - now).norm() / now.norm(), 0.1);
}

TEST(Tube, SupportsAnotherMeshOfTheParticle) {
  Fixture s(5);
  const spline::TMesh finer = spline::cube(4);
  const spline::Space space = spline::space(finer, spline::ExtraordinaryRule::g1);
  const Net x = surface::resting_shape(space, finer, s.shape);
  Tube other(s.tube->wall(), *s.flow, space, s.parameters, s.phases);
  EXPECT_EQ(&other.wall(), &s.tube->wall());  // the tubes share the assembled wall
  set_particle(other, space, x, 5);
  other.set_shape(x);
  const auto work = [](Tube& tube, const Net& net) {  // for a constant load and a rigid velocity; independent of the mesh
    const Net load = Eigen::RowVector3d(1, 0.5, 0).replicate(net.rows(), 1);
    return tube.respond(load, net).pressure_drop;
  };
  EXPECT_NEAR(work(other, x) / work(*s.tube, s.x), 1, 1e-3);
}

TEST(Tube, GivesItsResponseAtAnyPoint) {
  Fixture s(5);
  const Net x = s.x.rowwise() + Eigen::RowVector3d(7, 0, 0);
  s.tube->set_shape(x);
  const Tube::Response r = s.tube->respond(s.f, s.v);
  Net u(x.rows(), 3);
  std::vector<int> all(static_cast<std::size_t>(s.space.n_points));
  std::iota(all.begin(), all.end(), 0);
  s.tube->velocity_at(collocation_matrix(s.space), x, r, all, u);
  EXPECT_LT((u - r.velocity).norm() / u.norm(), 1e-12);
}

TEST(Tube, HasChecksThatAgreeForAForceFreeFlow) {
  // A load without net force, and a rigid velocity: both results are small differences of large terms.
  Fixture s(5);
  const Net v = Eigen::RowVector3d(1, 0, 0).replicate(s.x.rows(), 1);
  const Tube::Response r = s.tube->respond({}, v);
  const Tube::Checks c = s.tube->checks({}, v, r);
  EXPECT_NEAR(r.pressure_drop, 0, 1e-12);  // f_inf exerts no force on a closed surface, even on a coarse mesh
  EXPECT_NEAR(c.flux, 0, 1e-3);
  EXPECT_NEAR(c.force, 0, 1e-3);
  const Tube::Response pushed = s.tube->respond(s.f);
  const Tube::Checks routes = s.tube->checks(s.f, {}, pushed);
  EXPECT_NEAR(routes.pressure_by_flux / pushed.pressure_drop, 1, 0.02);  // coarse mesh of the wall
  EXPECT_NEAR(routes.pressure_by_force / pushed.pressure_drop, 1, 0.02);
}

TEST(FreeBodyInTube, IsInvariantUnderRotationAndTranslation) {
  Fixture s(1);
  SolverOptions solvers;
  solvers.tolerance = 1e-9;
  quadrature::Options quadrature;
  quadrature.tolerance = 1e-6;
  RigidTractions tractions(s.space, s.x, s.x, single_body(s.space, 0.5, viscosity, quadrature, solvers), {s.tube.get()}, {}, s.ranks);
  stokes::FlowOptions options;
  options.type = "duct", options.mean_velocity = 1.3;
  const FreeBodyInTube body(tractions, s.x, s.shape.center, 0.5, stokes::AmbientFlow(options, s.flow), viscosity);
  const State here = placed(s.shape.center);
  const RigidMotion motion = body.motion(here);
  const double drop = body.pressure_drop(here);
  EXPECT_GT(motion.velocity[0], 1.3);
  EXPECT_NEAR(motion.angular_velocity.dot(s.shape.center), 0, 1e-4);  // rotation by the shear of the profile
  State there = here;
  there(BlockId{0})(0, 0) -= 4;
  there(BlockId{1}) << std::sin(pi / 4), 0, 0, std::cos(pi / 4);  // rotation by 90 degrees about x1, which maps the cube mesh onto itself
  const double rules = 1e-5;  // other quadrature rules, with the tolerance 1e-6; another mesh would give 1e-3
  EXPECT_LT((body.motion(there).velocity - motion.velocity).norm(), rules);
  EXPECT_LT((body.motion(there).angular_velocity - motion.angular_velocity).norm(), rules);
  EXPECT_NEAR(body.pressure_drop(there) / drop, 1, rules);
  there(BlockId{0})(0, 1) = 0.6;  // trial position of a step that intersects the wall
  EXPECT_FALSE(body.motion(there).velocity.allFinite());
  EXPECT_TRUE(body.motion(here).velocity.allFinite());
}

}  // namespace tube_test
}  // namespace tanktread::coupling
