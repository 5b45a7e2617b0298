// Tests of contact forces between close particles: they solve the complementarity problem, and they are equal and opposite.

#include <random>

#include <gtest/gtest.h>

#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "system/contact.hpp"

namespace tanktread::coupling {
namespace {

TEST(Contact, ForcesNeverPullAndVanishAtOpenGaps) {
  std::mt19937 random(3);
  std::normal_distribution<double> number;
  for (int n = 1; n <= 12; ++n) {
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return number(random); });
    const Eigen::MatrixXd a = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
    const Eigen::VectorXd q = Eigen::VectorXd::NullaryExpr(n, [&] { return number(random); });
    const Eigen::VectorXd f = complementary(a, q), gap = a * f + q;
    EXPECT_GE(f.minCoeff(), 0);
    EXPECT_GE(gap.minCoeff(), -1e-10);
    EXPECT_LT(f.cwiseProduct(gap).cwiseAbs().maxCoeff(), 1e-10) << n;
    EXPECT_TRUE(complementary(a, q.cwiseAbs()).isZero(0));
  }
}

TEST(Contact, UnsolvableContactsGiveValuesThatAreNotFinite) {
  EXPECT_FALSE(complementary(Eigen::MatrixXd::Zero(1, 1), Eigen::VectorXd::Constant(1, -1)).allFinite());
}

TEST(Contact, ForcesAreEqualAndOppositeWithoutTorque) {
  const spline::TMesh mesh = spline::cube(3);
  const spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  const Net sphere = surface::resting_shape(space, mesh, {});
  std::vector<Particle> particles(2);
  particles[0].space = particles[1].space = &space;
  set_blocks(particles);
  Contact contact{{0, 1}, {spline::Site{4, 0.3, 0.6}, spline::Site{20, 1, 0.2}}};
  Net x(2 * space.n_points, 3);
  x << sphere, sphere;
  const Vec3 first = surface::value(space, sphere, contact.site[0]), second = surface::value(space, sphere, contact.site[1]);
  const Vec3 to = first + 0.1 * Vec3(1, 2, 2) / 3;  // position to which the second point is moved
  particles[1].block.rows(x).rowwise() += (to - second).transpose();
  contact.normal = Vec3(1, 2, 2) / 3, contact.force = 7;
  const Net on = work(particles, {{contact}}, x.rows());
  const auto total = [&](std::size_t p) { return Vec3(particles[p].block.rows(on).colwise().sum().transpose()); };
  EXPECT_LT((total(0) + 7 * contact.normal).norm(), 1e-13);
  EXPECT_LT((total(1) - 7 * contact.normal).norm(), 1e-13);
  Vec3 torque = Vec3::Zero();
  for (Eigen::Index a = 0; a < x.rows(); ++a) torque += Vec3(x.row(a).transpose()).cross(Vec3(on.row(a).transpose()));
  EXPECT_LT(torque.norm(), 1e-12);
}

}  // namespace
}  // namespace tanktread::coupling
