// Tests of a capsule in a tube: the forms of the block system, the Jacobian, and translation along the tube.

#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "base/timing.hpp"
#include "deck/section.hpp"
#include "membrane/laws.hpp"
#include "spline/extraction.hpp"
#include "surface/shapes.hpp"
#include "surface/walls/tube_wall.hpp"
#include "system/capsule.hpp"
#include "tests/states.hpp"

namespace tanktread::coupling {
namespace {

/// A capsule with a = 0.6 R_T off the axis, on a coarse mesh in a coarse tube; or, if `interface` is given, a drop with this motion of the control
/// points.
struct Confined {
  Phases phases;
  spline::Space space;
  Net unstressed, x;
  surface::TubeOptions options;
  std::shared_ptr<const stokes::DuctFlow> duct;
  std::optional<surface::TubeWall> wall;
  std::unique_ptr<Capsule> capsule;

  /// `period`: period of the tube; 0 if it has ends.
  Confined(double viscosity_ratio, const std::string& form, std::optional<MeshMotion> interface = {}, double period = 0,
           const std::string& volume = "auto") {
    const spline::TMesh mesh = spline::cube(3);
    space = spline::space(mesh, spline::ExtraordinaryRule::g1);
    const surface::LeastSquaresFit fit(space);
    const Net sphere = surface::unit_sphere(mesh, fit);
    const Eigen::RowVector3d centre(0, 0.05, -0.15);
    unstressed = (0.6 * sphere).rowwise() + centre;
    x = unstressed;
    x.col(0) += 0.1 * unstressed.col(2);
    options.radius = 1;
    options.azimuthal_elements = 8;
    options.axial_elements = 6;
    duct = std::make_shared<const stokes::DuctFlow>(options, 1.3, 1.0);
    wall.emplace(period > 0 ? surface::periodic_tube_wall(duct->outline(), options, period, 6)
                            : surface::tube_wall(duct->outline(), options, 2 * std::numbers::pi));
    stokes::FlowOptions flow;
    flow.type = "duct";
    flow.viscosity = 1.3;
    flow.mean_velocity = 1;
    CapsuleParameters parameters;
    parameters.solvers.frozen_operator = "assembled";  // on so few points, the sum over nodes would err by 3 per cent
    parameters.viscosity = 1.3;
    parameters.particles.front().viscosity_ratio = viscosity_ratio;
    parameters.particles.front().radius = 0.6;
    parameters.particles.front().material.law = membrane::NeoHookean{10};
    parameters.solvers.tube = form, parameters.solvers.volume = volume;
    parameters.solvers.tolerance = 1e-11;
    parameters.quadrature.tolerance = 1e-7;  // because differences of velocities are compared
    TubeParameters in_tube;
    if (interface) {
      parameters.particles.front().material.law = membrane::SurfaceTension{10};
      parameters.particles.front().measure = stokes::Measure::current;
      parameters.particles.front().interface_motion = *interface;
      parameters.particles.front().interface_speed = 1;
    }
    in_tube.viscosity = 1.3;
    capsule = std::make_unique<Capsule>(space, unstressed, unstressed, stokes::AmbientFlow(flow, duct), parameters, phases,
                                        std::make_unique<Tube>(*wall, *duct, space, in_tube, phases));
  }
};

TEST(CapsuleInTube, EveryFormOfTheBlockSystemGivesTheVelocityOfTheSchurComplement) {
  for (const double ratio : {1.0, 4.0}) {
    Confined schur(ratio, "schur");
    const Net v = schur.capsule->velocity(schur.x);
    for (const char* form : {"block triangular", "block diagonal"}) {
      Confined blocks(ratio, form);
      EXPECT_LT((blocks.capsule->velocity(blocks.x) - v).norm(), 1e-8 * v.norm()) << form;  // residuals of 1e-11, condition numbers of 1e3
      EXPECT_GT(blocks.capsule->counts().velocity_iterations, 0);
    }
  }
}

TEST(CapsuleInTube, EveryChoiceOfEliminatedBlocksGivesTheSameVelocity) {
  for (const double period : {0., 4.}) {
    Confined least(4, "schur", {}, period, "projection");
    const Net v = least.capsule->velocity(least.x);
    for (const char* form : {"schur", "block triangular"})
      for (const char* volume : {"projection", "multipliers"}) {
        Confined blocks(4, form, {}, period, volume);
        EXPECT_LT((blocks.capsule->velocity(blocks.x) - v).norm(), 1e-8 * v.norm())  // residuals of 1e-11, condition numbers of 1e3
            << form << " " << volume << " " << period;
      }
  }
}

// The wall responds to the fluid velocity on the interface. The tangential motion of the mesh has no influence.
TEST(CapsuleInTube, PressureDropOfADropDoesNotDependOnTheMotionOfTheMesh) {
  for (const double ratio : {0.2, 4.0}) {
    Confined material(ratio, "schur", MeshMotion::material);
    const double drop = material.capsule->evaluate(material.x)->response().pressure_drop;
    for (const MeshMotion motion : {MeshMotion::normal, MeshMotion::relaxed}) {
      Confined sliding(ratio, "schur", motion);
      EXPECT_NEAR(sliding.capsule->evaluate(sliding.x)->response().pressure_drop, drop, 1e-8 * std::abs(drop))
          << ratio << " " << deck::word(mesh_motions, motion);  // residuals of 1e-11, condition numbers of 1e3
      EXPECT_GT((sliding.capsule->velocity(sliding.x) - material.capsule->velocity(material.x)).norm(), 1e-2);
    }
  }
}

TEST(CapsuleInTube, CachedResultsOfAPositionAreReusedAndUnchanged) {
  for (const double ratio : {1.0, 4.0}) {
    Confined known(ratio, "schur"), fresh(ratio, "schur");
    const Net elsewhere = known.x.rowwise() + Eigen::RowVector3d(0.1, 0, 0.02);
    known.capsule->velocity(elsewhere);
    const Net v = known.capsule->velocity(known.x);
    EXPECT_EQ(known.capsule->velocity(known.x), v);
    EXPECT_EQ(known.capsule->counts().evaluations, 2);
    known.capsule->freeze(elsewhere);  // moves the tube's particle to the other shape
    const Tube::Response response = known.capsule->evaluate(known.x)->response();
    EXPECT_EQ(known.capsule->counts().evaluations, 2);

    EXPECT_EQ(fresh.capsule->velocity(fresh.x), v);
    const Net f = fresh.capsule->evaluate(fresh.x)->load();
    fresh.capsule->tube()->set_shape(fresh.x);
    const Tube::Response again = fresh.capsule->tube()->respond(f, v);
    EXPECT_EQ(response.wall_traction, again.wall_traction);
    EXPECT_EQ(response.pressure_drop, again.pressure_drop);
  }
}

TEST(CapsuleInTube, AVelocityCloseToTheSolutionOnlySavesIterations) {
  Confined plain(4, "schur"), helped(4, "schur");
  const Net v = plain.capsule->velocity(plain.x), start = v + 1e-5 * Net::Random(v.rows(), 3);
  EXPECT_LT((helped.capsule->evaluate(helped.x, start)->velocity() - v).norm(), 1e-8 * v.norm());  // residuals of 1e-11, condition numbers of 1e3
  EXPECT_LT(helped.capsule->counts().velocity_iterations, plain.capsule->counts().velocity_iterations);
}

TEST(CapsuleInTube, ARoughVelocityHasTheAllowedErrorAndIsNotCachedAsExact) {
  Confined exact(4, "schur"), rough(4, "schur");
  const Net v = exact.capsule->velocity(exact.x);
  int fewer = exact.capsule->counts().velocity_iterations;
  for (const double error : {1e-6, 1e-4, 1e-2}) {
    Confined scene(4, "schur");
    EXPECT_LT(scene.capsule->norm(scene.capsule->evaluate(scene.x, {}, error)->velocity() - v), error);
    EXPECT_LT(scene.capsule->counts().velocity_iterations, fewer) << error;
    fewer = scene.capsule->counts().velocity_iterations;
  }
  rough.capsule->evaluate(rough.x, {}, 1e-3);
  EXPECT_LT((rough.capsule->velocity(rough.x) - v).norm(), 1e-8 * v.norm());  // residuals of 1e-11, condition numbers of 1e3
  const long evaluations = rough.capsule->counts().evaluations;
  rough.capsule->evaluate(rough.x, {}, 1e-3);
  EXPECT_EQ(rough.capsule->counts().evaluations, evaluations);  // the exact velocity also serves as a rough one
}

// A particle of length 1.2 in a period of 1.4.
TEST(CapsuleInTube, TheFrozenResponseOfAPeriodicTubeContainsTheImagesOfTheParticle) {
  for (const double ratio : {1.0, 4.0}) {
    Confined scene(ratio, "schur", {}, 1.4);
    const Net v = scene.capsule->velocity(scene.x), f = scene.capsule->evaluate(scene.x)->load();
    scene.capsule->freeze(scene.x);
    const Net exact = scene.capsule->tube()->respond(f, v).velocity, images = scene.capsule->tube()->cause(f, v).velocity;
    const double error = (scene.capsule->tube()->frozen_response(f, v) - exact).norm();
    EXPECT_LT(error, 0.15 * exact.norm()) << ratio;  // images beyond the second are omitted, of the particle and of the wall
    EXPECT_GT(images.norm(), exact.norm()) << ratio;
  }
}

TEST(CapsuleInTube, TheFrozenOperatorSavesIterationsOfRoughVelocitiesOnly) {
  Confined plain(4, "schur"), helped(4, "schur"), exact(4, "schur"), after_step(4, "schur");
  for (Confined* one : {&helped, &after_step}) one->capsule->freeze(one->x), one->capsule->linearise(one->x);
  const Net v = exact.capsule->velocity(exact.x);
  EXPECT_EQ(after_step.capsule->velocity(after_step.x), v) << "a resumed run has no operator of the step before";
  const double error = 1e-4;
  for (Confined* one : {&plain, &helped}) EXPECT_LT(one->capsule->norm(one->capsule->evaluate(one->x, {}, error)->velocity() - v), error);
  EXPECT_LT(helped.capsule->counts().velocity_iterations, plain.capsule->counts().velocity_iterations);
}

TEST(CapsuleInTube, TheJacobianContainsTheResponseOfTheWall) {
  Confined scene(1, "schur");
  Capsule& capsule = *scene.capsule;
  Net delta = Net::Zero(scene.x.rows(), 3);
  for (Eigen::Index a = 0; a < delta.rows(); ++a) delta(a, 1) = 0.3 * scene.unstressed(a, 2) * scene.unstressed(a, 0);
  const double e = 1e-4;
  // Without a load the derivative of the operators vanishes, and (4.3) is exact except for the volume constraint.
  const Net difference = (capsule.velocity(scene.unstressed + e * delta) - capsule.velocity(scene.unstressed - e * delta)) / (2 * e);
  capsule.freeze(scene.unstressed);
  const Net jacobian = derivative_along(capsule, scene.unstressed, Net::Zero(delta.rows(), 3), delta);
  EXPECT_LT((jacobian - difference).norm(), 0.02 * difference.norm());  // the volume constraint contributes 1 per cent; entries are rounded
}

TEST(CapsuleInTube, ResultsDoNotDependOnThePositionAlongTheTube) {
  for (const double ratio : {1.0, 4.0}) {
    Confined scene(ratio, "schur");
    const Net v = scene.capsule->velocity(scene.x), there = scene.capsule->velocity(scene.x.rowwise() + Eigen::RowVector3d(17, 0, 0));
    EXPECT_LT((there - v).norm(), 1e-6 * v.norm());  // other quadrature rules, with the tolerance 1e-7
    Net along = Net::Zero(v.rows(), 3);
    along.col(0).setConstant(3);
    EXPECT_TRUE(scene.capsule->evaluated_about(scene.x + along, 1e-12)) << "operators of the shape are used again further along the tube";
    EXPECT_NEAR(scene.capsule->norm(along), 3 / scene.capsule->particles().front().radius, 1e-12) << "errors of positions count";
  }
}

TEST(CapsuleInTube, OutsideOfTheTubeTheVelocityIsUndefined) {
  Confined scene(1, "schur");
  EXPECT_FALSE(scene.capsule->velocity(scene.x.rowwise() + Eigen::RowVector3d(0, 0.5, 0)).allFinite());
}

}  // namespace
}  // namespace tanktread::coupling
