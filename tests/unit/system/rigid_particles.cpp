// Rigid bodies among other particles by the second-kind equation, compared with the first-kind equation, exact solutions for pairs, and very viscous
// drops.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "spline/extraction.hpp"
#include "spline/space.hpp"
#include "spline/t_mesh.hpp"
#include "surface/shapes.hpp"
#include "system/capsule.hpp"
#include "system/solids/bodies/rigid_body.hpp"

namespace tanktread::coupling {
namespace rigid_particles_test {

using std::numbers::pi;
constexpr double viscosity = 1.7;

/// Bodies on cube meshes, in a linear flow.
struct Bodies {
  std::vector<spline::Space> spaces;
  spline::Space space;
  std::vector<Net> nets;
  Net rest;
  CapsuleParameters parameters;
  Ranks ranks;
  Phases phases;
  stokes::AmbientFlow flow;

  struct One {
    Vec3 centre, semi_axes = Vec3::Ones();
    std::optional<RigidDrive> rigid = RigidDrive{};
    double viscosity_ratio = 1;
    int elements = 0;  // per side; 0: n
  };
  Bodies(const std::vector<One>& bodies, int n, const Mat3& gradient) {
    std::vector<const spline::Space*> all;
    for (const One& one : bodies) {
      const spline::TMesh mesh = spline::cube(one.elements > 0 ? one.elements : n);
      spaces.push_back(spline::space(mesh, spline::ExtraordinaryRule::g1));
      surface::ParticleShape shape;
      shape.shape = "ellipsoid", shape.semi_axes = one.semi_axes, shape.center = one.centre;
      nets.push_back(surface::resting_shape(spaces.back(), mesh, shape));
    }
    for (const spline::Space& one : spaces) all.push_back(&one);
    space = spline::stacked(all);
    parameters.viscosity = viscosity;
    parameters.quadrature.tolerance = 1e-7, parameters.solvers.tolerance = 1e-11;
    parameters.particles.resize(bodies.size());
    const std::vector<spline::Block> blocks = spline::blocks(all);
    rest.resize(space.n_points, 3);
    for (size_t p = 0; p < bodies.size(); ++p) {
      Particle& particle = parameters.particles[p];
      particle.space = &spaces[p], particle.block = blocks[p];
      particle.rigid = bodies[p].rigid, particle.viscosity_ratio = bodies[p].viscosity_ratio;
      particle.material.law = membrane::SurfaceTension{bodies[p].rigid ? 0. : 1.};
      particle.radius = std::cbrt(bodies[p].semi_axes.prod());
      blocks[p].rows(rest) = nets[p];
    }
    stokes::FlowOptions options;
    options.type = "linear", options.gradient = gradient;
    flow = stokes::AmbientFlow(options);
  }
  Capsule system() { return Capsule(space, rest, rest, flow, parameters, phases); }
};

Mat3 some_gradient() {
  Mat3 l;
  l << 0.5, 0.3, 1.0, -0.4, 0.2, 0.6, 0.1, -0.8, -0.7;
  return l;
}

/// The integral equations of the first and the second kind share nothing but the body.
TEST(RigidParticles, OneMovesAsByTheFirstKindEquation) {
  const Vec3 centre(0.3, -0.1, 0.2), axes(1.3, 0.8, 1);
  const RigidDrive driven{false, {}, Vec3(1, -2, 3), Vec3(2, 1, -1)};
  Bodies one({{centre, axes, driven}}, 6, some_gradient());
  Capsule system = one.system();
  Net x = one.rest;
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  x = ((x.rowwise() - centre.transpose()) * turn.transpose()).rowwise() + centre.transpose();
  const CapsuleParameters alone = single_body(one.space, 1, viscosity, one.parameters.quadrature, one.parameters.solvers);
  RigidTractions tractions(one.space, one.rest, one.rest, alone, {}, {}, one.ranks);
  FreeBody body(tractions, one.rest, centre, 1, one.flow, driven);
  State place = placed(centre);
  place(BlockId{1}) = Eigen::Quaterniond(turn).coeffs().transpose();
  const RigidMotion expected = body.motion(place);
  const RigidParticles found = system.evaluate(x)->rigid();
  EXPECT_LT((found.motion(0).velocity - expected.velocity).norm(), 2e-5);  // n = 6: the collocation error is 1e-5 of the velocity
  EXPECT_LT((found.motion(0).angular_velocity - expected.angular_velocity).norm(), 5e-5);
  EXPECT_LT((system.evaluate(x)->stresslet() - body.stresslet(place)).norm(), 1e-4 * body.stresslet(place).norm());
}

TEST(RigidParticles, ForcesOfAPrescribedMotionCauseThisMotion) {
  const Vec3 away(0.5, 0.4, 2.6);
  RigidDrive told{true, {Vec3(1, 2, -1), Vec3(0.5, -1, 2)}};
  Bodies held({{Vec3::Zero(), Vec3(1.2, 1, 0.8), told}, {away, Vec3::Ones(), RigidDrive{true, {}}}}, 4, some_gradient());
  Capsule system = held.system();
  const RigidParticles forced = system.evaluate(held.rest)->rigid();
  Bodies free({{Vec3::Zero(), Vec3(1.2, 1, 0.8), RigidDrive{false, {}, forced.force(0), forced.torque(0)}},
               {away, Vec3::Ones(), RigidDrive{false, {}, forced.force(1), forced.torque(1)}}}, 4, some_gradient());
  Capsule other = free.system();
  const RigidParticles moved = other.evaluate(free.rest)->rigid();
  // Between the collocation sites, the residuals of the two problems differ.
  EXPECT_LT((moved.motion(0).velocity - told.motion.velocity).norm(), 5e-4);
  EXPECT_LT((moved.motion(0).angular_velocity - told.motion.angular_velocity).norm(), 5e-4);
  EXPECT_LT(moved.motion(1).velocity.norm() + moved.motion(1).angular_velocity.norm(), 1e-3);
}

/// Compared with the multipole solution for two spheres whose centres are 3 apart (functions of Jeffrey & Onishi).
TEST(RigidParticles, PairsOfSpheresHaveTheirResistance) {
  const RigidDrive pulled{true, {Vec3(1, 0, 0), Vec3::Zero()}}, held{true, {}};
  Bodies pair({{Vec3::Zero(), Vec3::Ones(), pulled}, {Vec3(3, 0, 0), Vec3::Ones(), held}}, 4, Mat3::Zero());
  Capsule system = pair.system();
  const RigidParticles along = system.evaluate(pair.rest)->rigid();
  const double unit = 6 * pi * viscosity;
  EXPECT_NEAR(along.force(0)[0] / unit, 1.3684796, 2e-4);  // n = 4; fourth order in the element size
  EXPECT_NEAR(along.force(1)[0] / unit, -0.670175042, 2e-4);
  EXPECT_LT(along.torque(0).norm() + along.torque(1).norm(), 1e-6);
  Bodies free({{Vec3::Zero(), Vec3::Ones(), RigidDrive{}}, {Vec3(3, 0, 0), Vec3::Ones(), RigidDrive{}}}, 4, Mat3(Vec3(1, -0.5, -0.5).asDiagonal()));
  Capsule in_strain = free.system();
  const RigidParticles moved = in_strain.evaluate(free.rest)->rigid();
  EXPECT_NEAR(1 - (moved.motion(1).velocity - moved.motion(0).velocity)[0] / 3, 0.186662636, 1e-4);  // A
  EXPECT_NEAR(in_strain.evaluate(free.rest)->stresslet()(0, 0) / (20 * pi * viscosity / 3), 1.17172019, 2e-4);  // S0
}

/// The surface is slightly higher at its collocation sites than between them. Without correction the error of the torque is 1.3e-4.
TEST(RigidParticles, TheErrorOfALoadBetweenSitesIsCorrected) {
  const RigidDrive turned{true, {Vec3::Zero(), Vec3(0, 0, 1)}};
  Bodies one({{Vec3::Zero(), Vec3::Ones(), turned}}, 4, Mat3::Zero());
  Capsule system = one.system();
  EXPECT_NEAR(system.evaluate(one.rest)->rigid().torque(0)[2] / (8 * pi * viscosity), 1, 1e-5);  // the volume equals that of the sphere to 1e-6
}

/// The density needs a correction too. Without it the error of the stresslet is 1.4e-4.
TEST(RigidParticles, TheErrorOfADensityBetweenSitesIsCorrected) {
  Bodies one({{Vec3::Zero(), Vec3::Ones(), RigidDrive{}}}, 4, Mat3(Vec3(1, -0.5, -0.5).asDiagonal()));
  Capsule system = one.system();
  EXPECT_NEAR(system.evaluate(one.rest)->stresslet()(0, 0) / (20 * pi * viscosity / 3), 1, 1e-5);
}

/// With the inverses of isolated bodies only, the narrower gap takes 41 iterations.
TEST(RigidParticles, IterationsDoNotGrowAsAFilmThins) {
  const RigidDrive pulled{true, {Vec3(1, 0.5, 0), Vec3(0, 1, 2)}}, held{true, {}};
  std::vector<long> iterations;
  for (const double gap : {0.1, 0.005}) {
    Bodies pair({{Vec3::Zero(), Vec3::Ones(), pulled}, {Vec3(2 + gap, 0, 0), Vec3(1, 1.2, 0.8), held}}, 7, Mat3::Zero());
    pair.parameters.solvers.tolerance = 1e-8;
    Capsule system = pair.system();
    system.velocity(pair.rest);
    iterations.push_back(system.counts().most_velocity_iterations);
  }
  EXPECT_LE(iterations[0], 20);
  EXPECT_LE(iterations[1], 20);
}

/// The limit of infinite viscosity is approached like 1/lambda.
TEST(RigidParticles, VeryViscousDropsMoveLikeRigidBodies) {
  const auto velocity = [](double viscosity_ratio) {
    const std::optional<RigidDrive> rigid = viscosity_ratio > 0 ? std::nullopt : std::optional(RigidDrive{});
    const double ratio = std::max(viscosity_ratio, 1.);
    Bodies pair({{Vec3::Zero(), Vec3::Ones(), rigid, ratio}, {Vec3(2.2, 0.3, 0.4), Vec3(1, 1.1, 0.9), rigid, ratio}}, 4, some_gradient());
    for (Particle& one : pair.parameters.particles) one.measure = stokes::Measure::current;
    return pair.system().velocity(pair.rest);
  };
  const Net rigid = velocity(0);
  const auto difference = [&](double viscosity_ratio) { return (velocity(viscosity_ratio) - rigid).norm() / rigid.norm(); };
  EXPECT_NEAR(difference(1e2) / difference(1e3), 10, 0.5);
  EXPECT_LT(difference(1e4), 3e-4);  // includes the collocation error of the drops
}

/// The net of a stage of a time step is not a rigid image of the body; it represents the nearest rigid image.
TEST(RigidParticles, KeepTheirShape) {
  Bodies pair({{Vec3::Zero(), Vec3(1.2, 1, 0.8)}, {Vec3(3, 0.2, 0), Vec3::Ones()}}, 3, some_gradient());
  Capsule system = pair.system();
  Net x = pair.rest + 0.3 * system.velocity(pair.rest);
  const Net stage = x;
  system.restore_constraints(x);
  EXPECT_GT((x - stage).norm(), 1e-3);
  for (size_t p = 0; p < 2; ++p) {
    const Net now = pair.parameters.particles[p].block.rows(x);
    const Eigen::RowVector3d mean = now.colwise().mean(), mean_at_rest = pair.nets[p].colwise().mean();
    const Eigen::MatrixXd y = now.rowwise() - mean, r = pair.nets[p].rowwise() - mean_at_rest;
    EXPECT_LT((y * y.transpose() - r * r.transpose()).norm(), 1e-12 * r.squaredNorm()) << p;  // all distances between points
  }
  EXPECT_LT((system.velocity(stage) - system.velocity(x)).norm(), 1e-9);
}

struct ByTractions : Bodies {
  ByTractions(const std::vector<One>& bodies, int n, const Mat3& gradient, bool by_tractions = true) : Bodies(bodies, n, gradient) {
    for (Particle& one : parameters.particles) one.by_traction = one.rigid && by_tractions;
  }
};

TEST(RigidTractions, AFailedSolveKeepsTheInitialGuess) {
  Bodies one({{Vec3::Zero(), Vec3::Ones(), RigidDrive{}}}, 3, Mat3::Zero());
  const CapsuleParameters alone = single_body(one.space, 1, viscosity, one.parameters.quadrature, one.parameters.solvers);
  RigidTractions tractions(one.space, one.rest, one.rest, alone, {}, {}, one.ranks);
  const auto fails = [](const double*, double* out) { std::fill_n(out, 3, std::numeric_limits<double>::quiet_NaN()); };
  const LinearSystem system{one_block("traction", 3), fails, {}};
  Eigen::VectorXd unknowns = Eigen::VectorXd::Ones(3);
  EXPECT_THROW(tractions.solve_iteratively(system, Eigen::VectorXd::Ones(3), unknowns), RunFailure);
  EXPECT_TRUE(unknowns == Eigen::VectorXd::Ones(3));
}

/// The force on spheres that approach each other, compared with the multipole solution above.
TEST(RigidTractions, AreMoreAccurateThanDoubleLayers) {
  const RigidDrive one{true, {Vec3(1, 0, 0), Vec3::Zero()}}, other{true, {Vec3(-1, 0, 0), Vec3::Zero()}};
  const auto error = [&](auto pair) {
    Capsule system = pair->system();
    return std::abs(system.evaluate(pair->rest)->rigid().force(0)[0] / (6 * pi * viscosity) - (1.3684796 + 0.670175042));
  };
  const std::vector<Bodies::One> bodies{{Vec3::Zero(), Vec3::Ones(), one}, {Vec3(3, 0, 0), Vec3::Ones(), other}};
  EXPECT_LT(10 * error(std::make_unique<ByTractions>(bodies, 4, Mat3::Zero())), error(std::make_unique<Bodies>(bodies, 4, Mat3::Zero())));
}

TEST(RigidTractions, PairsInStrainHaveTheKnownVelocityAndStresslet) {
  const Mat3 strain = Vec3(1, -0.5, -0.5).asDiagonal();
  ByTractions free({{Vec3::Zero(), Vec3::Ones(), RigidDrive{}}, {Vec3(3, 0, 0), Vec3::Ones(), RigidDrive{}}}, 4, strain);
  Capsule system = free.system();
  const RigidParticles moved = system.evaluate(free.rest)->rigid();
  EXPECT_NEAR(1 - (moved.motion(1).velocity - moved.motion(0).velocity)[0] / 3, 0.186662636, 2e-6);  // the surfaces are spheres to 1e-6
  EXPECT_NEAR(system.evaluate(free.rest)->stresslet()(0, 0) / (20 * pi * viscosity / 3), 1.17172019, 3e-5);  // 1.8e-4 without the correction
}

TEST(RigidTractions, AStressletIsThatOfItsEvaluationAfterAnotherShapeWasSolved) {
  ByTractions pair({{Vec3::Zero(), Vec3::Ones(), RigidDrive{}}, {Vec3(3, 0, 0), Vec3::Ones(), RigidDrive{}}}, 3, some_gradient());
  pair.parameters.quadrature.tolerance = 1e-5;
  Capsule system = pair.system();
  const auto here = system.evaluate(pair.rest);
  const Mat3 stresslet = here->stresslet(1);
  Net apart = pair.rest;
  apart.bottomRows(apart.rows() / 2).rowwise() += Eigen::RowVector3d(0, 2, 0);
  const Mat3 there = system.evaluate(apart)->stresslet(1);
  EXPECT_GT((there - stresslet).norm(), 1e-2 * stresslet.norm());
  EXPECT_LT((here->stresslet(1) - stresslet).norm(), 1e-12 * stresslet.norm());
}

TEST(RigidTractions, ForcesOfAPrescribedMotionCauseThisMotion) {
  const Vec3 away(0.5, 0.4, 2.6);
  const RigidDrive told{true, {Vec3(1, 2, -1), Vec3(0.5, -1, 2)}};
  ByTractions held({{Vec3::Zero(), Vec3(1.2, 1, 0.8), told}, {away, Vec3::Ones(), RigidDrive{}}}, 4, some_gradient());
  Capsule system = held.system();
  const RigidParticles forced = system.evaluate(held.rest)->rigid();
  const RigidDrive driven{false, {}, forced.force(0), forced.torque(0)};
  ByTractions free({{Vec3::Zero(), Vec3(1.2, 1, 0.8), driven}, {away, Vec3::Ones(), RigidDrive{}}}, 4, some_gradient());
  Capsule other = free.system();
  const RigidParticles moved = other.evaluate(free.rest)->rigid();
  // The remaining difference is the collocation error of the correction itself.
  EXPECT_LT((moved.motion(0).velocity - told.motion.velocity).norm(), 1e-5);
  EXPECT_LT((moved.motion(1).velocity - forced.motion(1).velocity).norm(), 1e-5);
}

/// Drag of a sphere that moves along a plane wall at a gap of one radius: Goldman, Cox & Brenner 1967.
TEST(RigidTractions, DragNextToAWallIsTheKnownOne) {
  ByTractions one({{Vec3(0.2, 0, 2), Vec3::Ones(), RigidDrive{true, {Vec3(1, 0, 0), Vec3::Zero()}}}}, 4, Mat3::Zero());
  one.parameters.medium = std::make_shared<stokes::PlaneWall>(Vec3::Zero(), Vec3(0, 0, 1));
  Capsule system = one.system();
  EXPECT_NEAR(system.evaluate(one.rest)->rigid().force(0)[0] / (6 * pi * viscosity), 1.38275238, 1e-5);
}

/// Drag of a simple cubic array of spheres at the volume fraction 0.2: multipoles with Ewald sums.
TEST(RigidTractions, DragInAnArrayIsTheKnownOne) {
  ByTractions one({{Vec3::Zero(), Vec3::Ones(), RigidDrive{true, {Vec3(1, 0, 0), Vec3::Zero()}}}}, 4, Mat3::Zero());
  one.parameters.cell = stokes::PeriodicCell(2.7564674676 * Mat3::Identity(), 3);
  one.parameters.quadrature.tolerance = 1e-6, one.parameters.solvers.tolerance = 1e-8;
  Capsule system = one.system();
  EXPECT_NEAR(system.evaluate(one.rest)->rigid().force(0)[0] / (6 * pi * viscosity) / 6.775920032, 1, 1e-5);  // 3e-4 by double layers
}

/// A drop 50 radii away changes the motion by 1e-6 at most: the force on the pair causes a strain of order 1/r^2 at the drop, and the stresslet of
/// the drop a velocity of order 1/r^4 at the pair.
TEST(RigidTractions, ADistantDropHasNoInfluence) {
  const RigidDrive pulled{false, {}, Vec3(6 * pi * viscosity, 0, 0), Vec3::Zero()};
  std::vector<Bodies::One> bodies{{Vec3::Zero(), Vec3::Ones(), pulled}, {Vec3(3, 0, 0), Vec3::Ones(), RigidDrive{}}};
  ByTractions pair(bodies, 4, Mat3::Zero());
  Capsule two = pair.system();
  const RigidParticles alone = two.evaluate(pair.rest)->rigid();
  bodies.insert(bodies.begin() + 1, {Vec3(0, 50, 0), Vec3::Ones(), std::nullopt, 5, 3});
  ByTractions among(bodies, 4, Mat3::Zero());
  Capsule system = among.system();
  const RigidParticles moved = system.evaluate(among.rest)->rigid();
  EXPECT_NEAR(moved.motion(0).velocity[0], 0.96127974, 2e-6);  // x^a_11 and x^a_12 of the pair: multipoles
  EXPECT_NEAR(moved.motion(2).velocity[0], 0.47076017, 2e-6);
  EXPECT_LT((moved.motion(0).velocity - alone.motion(0).velocity).norm() + (moved.motion(2).velocity - alone.motion(1).velocity).norm(), 1e-6);
}

/// Motion and stresslet of a rigid body next to a drop in a linear flow, and the velocity of the drop.
struct BesideDrop {
  Eigen::Matrix<double, 12, 1> of_body;
  Vec3 of_drop;

  BesideDrop(bool by_tractions, int n, double viscosity_ratio) {
    const RigidDrive pulled{false, {}, Vec3(3, -2, 1), Vec3(1, 0, -1)};
    ByTractions scene({{Vec3(0, 0, 2), Vec3(1, 1.1, 0.9), std::nullopt, viscosity_ratio, 6}, {Vec3(2.4, 0.2, 2.3), Vec3(1, 0.9, 1.1), pulled}}, n,
                      some_gradient(), by_tractions);
    scene.parameters.quadrature.tolerance = 1e-6, scene.parameters.solvers.tolerance = 1e-8;
    Capsule system = scene.system();
    const auto found = system.evaluate(scene.rest);
    const RigidMotion motion = found->rigid().motion(1);
    const Mat3 stresslet = found->stresslet(1) / viscosity;
    of_body << motion.velocity, motion.angular_velocity, stresslet.diagonal(), stresslet(0, 1), stresslet(1, 2), stresslet(2, 0);
    of_drop = scene.parameters.particles[0].block.rows(found->velocity()).colwise().mean().transpose();
  }
};

void expect_agreement(const BesideDrop& fine, double viscosity_ratio) {
  const BesideDrop coarse(true, 3, viscosity_ratio), finer(true, 5, viscosity_ratio);
  const auto error = [&](const BesideDrop& other) {
    return (other.of_body - fine.of_body).norm() / fine.of_body.norm() + (other.of_drop - fine.of_drop).norm();
  };
  EXPECT_LT(error(coarse), 2e-3);  // 1e-4 to 7e-4
  EXPECT_LT(error(finer), 2e-5);   // measured: 1e-5, partly due to the double layers
}

TEST(RigidTractions, MoveNextToADropAsWithDoubleLayers) {
  for (const double ratio : {1., 5.}) expect_agreement(BesideDrop(false, 8, ratio), ratio);
}

}  // namespace rigid_particles_test
}  // namespace tanktread::coupling
