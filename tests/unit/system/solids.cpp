// Tests of plates and posts in a lattice without particles: exact solutions, and the balance of forces.

#include "system/solids/plates/plates_and_posts.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "system/solids/plates/solid_response.hpp"

namespace tanktread::coupling {
namespace {

const stokes::PeriodicCell& slab() {
  static const stokes::PeriodicCell cell((Mat3() << 2, 0, 0, 0, 1.5, 0, 0, 0, 0).finished(), 2);
  return cell;
}

std::vector<PlatesAndPosts::Solid> plates(double distance, const Vec3& lower, const Vec3& upper) {
  const Vec3 first = slab().vectors().col(0), second = slab().vectors().col(1);
  return {{surface::plate(Vec3::Zero(), first, second, {4, 4}), lower}, {surface::plate(distance * Vec3::UnitZ(), first, second, {4, 4}), upper}};
}

std::vector<Vec3> directions() { return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}; }

quadrature::Options fine() {
  quadrature::Options options;
  options.tolerance = 1e-8;
  return options;
}

/// The sheets of force f1, f2 move the fluid by -(|z - z1| f1 + |z - z2| f2)/(2 mu), which is V1 and V2 on them.
TEST(PlatesAndPosts, MovingPlatesHaveUniformForces) {
  Phases phases;
  const double mu = 0.7, d = 1.3;
  const Vec3 lower(0.3, -0.2, 0), upper(-1, 0.5, 0);
  PlatesAndPosts solids(plates(d, lower, upper), {slab(), {}, mu, fine()}, phases);
  const PlatesAndPosts::Flow flow = solids.solve(solids.velocities(), Vec3::Zero());
  const std::vector<Vec3> forces = solids.forces(flow.force);
  EXPECT_LT((forces[1] + 2 * mu * 3 / d * lower).norm(), 1e-6);
  EXPECT_LT((forces[0] + 2 * mu * 3 / d * upper).norm(), 1e-6);
  const Eigen::RowVector3d mean = -2 * mu / d * upper.transpose();
  EXPECT_LT((flow.force.topRows(16).rowwise() - mean).cwiseAbs().maxCoeff(), 1e-5);
  Net at(2, 3), u(2, 3);
  at << 0.4, 0.1, 0.5, -0.9, 0.7, 1.0;
  solids.velocity_at({.at = at, .own = {0, 1}}, flow, u);
  for (int i = 0; i < 2; ++i) EXPECT_LT((u.row(i).transpose() - (lower + (upper - lower) * at(i, 2) / d)).norm(), 1e-6);
}

TEST(PlatesAndPosts, VelocitiesAtAPlateDoNotDependOnEarlierTargets) {
  Phases phases;
  const std::vector<PlatesAndPosts::Solid> plate{plates(1, Vec3::Zero(), Vec3::Zero()).front()};
  const std::vector<Vec3> along{Vec3::UnitX(), Vec3::UnitY()};
  PlatesAndPosts fresh(plate, {slab(), along, 1, fine()}, phases), used(plate, {slab(), along, 1, fine()}, phases);
  Net u = Net::Zero(fresh.sites().rows(), 3);
  u.row(5) << 0.3, -0.1, 0.2;
  const PlatesAndPosts::Flow flow = fresh.solve(u, Vec3(1, 0.5, 0));
  for (const double height : {0.5, 2.7}) {  // inside and outside of the initial range of targets; a period has the length 2
    const Net at = Vec3(0.4, 0.1, height).transpose(), far = Vec3(0.4, 0.1, 9).transpose();
    Net by_fresh(1, 3), by_used(1, 3);
    fresh.reach(at), used.reach(far), used.reach(at);
    fresh.velocity_at({.at = at, .own = {0}}, flow, by_fresh), used.velocity_at({.at = at, .own = {0}}, flow, by_used);
    EXPECT_EQ(by_fresh, by_used) << height;
  }
}

TEST(PlatesAndPosts, AreSharedOnlyIfTheyAndTheirVelocitiesAreEqual) {
  Phases phases;
  const Vec3 lower(0.3, -0.2, 0), upper(-1, 0.5, 0);
  const PlatesAndPosts::Parameters parameters{slab(), {}, 0.7, fine()}, other{slab(), {}, 0.8, fine()};
  const PlatesAndPosts solids(plates(1.3, lower, upper), parameters, phases);
  EXPECT_TRUE(solids.is_for(plates(1.3, lower, upper), parameters));
  EXPECT_FALSE(solids.is_for(plates(1.3, lower, upper), other));
  EXPECT_FALSE(solids.is_for(plates(1.2, lower, upper), parameters));
  EXPECT_FALSE(solids.is_for(plates(1.3, lower, -upper), parameters));
  EXPECT_FALSE(solids.is_for({plates(1.3, lower, upper).front()}, parameters));
}

TEST(PlatesAndPosts, ForcesBalanceThePressureGradient) {
  Phases phases;
  const stokes::PeriodicCell cell(Mat3(Vec3(1, 1.2, 0.8).asDiagonal()), 3);
  const std::vector<PlatesAndPosts::Solid> post{{surface::cylinder(Vec3(0.1, 0.2, 0), Vec3(0, 0, 0.8), 0.25, 12, 6), Vec3::Zero(), {}}};
  const auto posts = std::make_shared<PlatesAndPosts>(post, PlatesAndPosts::Parameters{cell, directions(), 2, fine()}, phases);
  const Vec3 gradient(-1, 0.5, 0.3);
  const SolidScene scene{posts, {}, gradient, fine()};
  const PlatesAndPosts::Flow flow = without_particles(scene, stokes::AmbientFlow());
  EXPECT_LT((posts->forces(flow.force)[0] - cell.volume() * gradient).norm(), 1e-10);
  EXPECT_GT(flow.drift[0], 0);
  EXPECT_LT(flow.drift[1], 0);
}

/// Square array, F/(mu U) by the table of Sangani & Acrivos (1982). Their series to the third power of the area fraction errs by 1.5e-2 at 0.2.
TEST(PlatesAndPosts, PostsInASquareArrayHaveTheKnownForce) {
  Phases phases;
  for (const auto& [c, expected] : {std::pair(0.05, 15.56), {0.2, 51.53}, {0.4, 217.89}}) {
    const stokes::PeriodicCell cell(Mat3(Vec3(1, 1, 0.5).asDiagonal()), 3);
    const double radius = std::sqrt(c / std::numbers::pi);
    const std::vector<PlatesAndPosts::Solid> post{{surface::cylinder(Vec3::Zero(), Vec3(0, 0, 0.5), radius, 20, 4), Vec3::Zero(), {}}};
    const auto posts = std::make_shared<PlatesAndPosts>(post, PlatesAndPosts::Parameters{cell, directions(), 1, fine()}, phases);
    const SolidScene scene{posts, {}, -Vec3::UnitX(), fine()};
    const PlatesAndPosts::Flow flow = without_particles(scene, stokes::AmbientFlow());
    EXPECT_NEAR(1 / flow.drift[0] / expected, 1, 2e-4) << "area fraction " << c;
  }
}

}  // namespace
}  // namespace tanktread::coupling
