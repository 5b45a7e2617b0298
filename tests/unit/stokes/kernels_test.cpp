#include "stokes/kernels/kernels.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <vector>

#include "stokes/kernels/far_kernel.hpp"

namespace tanktread::stokes {
namespace {

const Vec3 r(0.3, -0.7, 1.1);

TEST(Stokeslet, IsSymmetricAndFallsWithTheDistance) {
  EXPECT_NEAR((stokeslet(r) - stokeslet(r).transpose()).norm(), 0, 1e-16);
  EXPECT_NEAR((stokeslet(2 * r) - stokeslet(r) / 2).norm(), 0, 1e-15);
  EXPECT_NEAR((stokeslet(r) * r - 2 * r / r.norm()).norm(), 0, 1e-15);  // along the force: 2/r
}

TEST(Stokeslet, IsFreeOfDivergence) {
  const double h = 1e-5;
  Vec3 divergence = Vec3::Zero();
  for (int i = 0; i < 3; ++i)
    divergence += (stokeslet(r + h * Vec3::Unit(i)).row(i) - stokeslet(r - h * Vec3::Unit(i)).row(i)).transpose() / (2 * h);
  EXPECT_LT(divergence.norm(), 1e-9);  // central differences: h^2 and round-off over h
}

// The stress sigma_ik of the velocity G_ij g_j (viscosity 1) is T_ijk g_j, and the pressure is 2 r.g / r^3.
TEST(Stresslet, IsTheStressOfTheStokeslet) {
  const double h = 1e-5;
  const Vec3 g(0.2, 0.9, -0.4), n = Vec3(1, 2, -2) / 3;
  Mat3 gradient;  // d u_i / d x_k
  for (int k = 0; k < 3; ++k) gradient.col(k) = (stokeslet(r + h * Vec3::Unit(k)) - stokeslet(r - h * Vec3::Unit(k))) * g / (2 * h);
  const double pressure = 2 * r.dot(g) / std::pow(r.norm(), 3);
  const Vec3 traction = -pressure * n + (gradient + gradient.transpose()) * n;
  EXPECT_LT((stresslet(r, n) * g - traction).norm(), 1e-8);
}

TEST(FreeSpaceKernels, AreZeroAtTheTarget) {
  const Vec3 n = Vec3(1, 2, -2) / 3;
  EXPECT_EQ(stokeslet(Vec3::Zero()), Mat3::Zero());
  EXPECT_EQ(stresslet(Vec3::Zero(), n), Mat3::Zero());
}

struct Forces {
  std::vector<double> values;
  Charges view;

  explicit Forces(int n) : values(static_cast<std::size_t>(6) * n) {
    std::mt19937 random(1);
    for (double& v : values) v = std::uniform_real_distribution<>(-1, 1)(random);
    const double* v = values.data();
    view = {n, v, v + n, v + 2 * n, {v + 3 * n, v + 4 * n, v + 5 * n}};
  }
  Vec3 position(int k) const { return {view.x[k], view.y[k], view.z[k]}; }
  Vec3 force(int k) const { return {view.q[0][k], view.q[1][k], view.q[2][k]}; }
};

TEST(FarSum, IsTheSumOfStokeslets) {
  const Forces forces(37);
  double target[3 * far_block], u[3 * far_block];
  for (int k = 0; k < 3 * far_block; ++k) target[k] = std::sin(k);
  stokeslet_sum(forces.view, target, u);
  for (int l = 0; l < far_block; ++l) {
    const Vec3 x0(target[l], target[far_block + l], target[2 * far_block + l]);
    Vec3 sum = Vec3::Zero(), one;
    for (int k = 0; k < forces.view.n; ++k) sum += stokeslet(forces.position(k) - x0) * forces.force(k);
    EXPECT_LT((Vec3(u[l], u[far_block + l], u[2 * far_block + l]) - sum).norm(), 1e-12 * sum.norm());
    node_sum(forces.view, x0.data(), one.data());
    EXPECT_LT((one - sum).norm(), 1e-12 * sum.norm());
  }
}

// 1/r of one node in every lane, for values outside the range of single precision, in which some processors compute initial estimates of 1/r.
TEST(FarSum, IsAccurateAtEveryScale) {
  for (double scale = 1e-100; scale < 1e100; scale *= 7.3) {
    const Vec3 place = scale * r, force(0.4, -0.2, 0.9);
    double target[3 * far_block] = {}, u[3 * far_block];
    for (int l = 0; l < far_block; ++l) target[l] = 0.1 * l * scale;
    stokeslet_sum(Charges{1, &place[0], &place[1], &place[2], {&force[0], &force[1], &force[2]}}, target, u);
    for (int l = 0; l < far_block; ++l) {
      const Vec3 exact = stokeslet(place - Vec3(target[l], 0, 0)) * force;
      EXPECT_LT((Vec3(u[l], u[far_block + l], u[2 * far_block + l]) - exact).norm(), 1e-14 * exact.norm()) << scale;
    }
  }
}

// The sum of a target does not depend on its neighbours, for any instruction set.
TEST(FarSum, OfATargetIsBitwiseEqualInEveryLane) {
  const Forces forces(37);
  double target[3 * far_block], u[3 * far_block];
  for (int k = 0; k < 3 * far_block; ++k) target[k] = std::sin(k / far_block + 1);
  stokeslet_sum(forces.view, target, u);
  for (int c = 0; c < 3; ++c)
    for (int l = 1; l < far_block; ++l) EXPECT_EQ(u[far_block * c + l], u[far_block * c]);
}

TEST(FarSum, OmitsANodeAtTheTarget) {
  Forces forces(5);
  double target[3 * far_block], u[3 * far_block];
  for (int l = 0; l < far_block; ++l)  // exact coincidence in the first lane, up to rounding in the others
    for (int c = 0; c < 3; ++c) target[far_block * c + l] = forces.position(2)[c] * (1 + 1e-16 * l * (c + 1));
  stokeslet_sum(forces.view, target, u);
  Vec3 sum = Vec3::Zero(), one;
  for (const int k : {0, 1, 3, 4}) sum += stokeslet(forces.position(k) - forces.position(2)) * forces.force(k);
  for (int l = 0; l < far_block; ++l) {
    EXPECT_LT((Vec3(u[l], u[far_block + l], u[2 * far_block + l]) - sum).norm(), 1e-12 * sum.norm());
    node_sum(forces.view, Vec3(target[l], target[far_block + l], target[2 * far_block + l]).data(), one.data());
    EXPECT_LT((one - sum).norm(), 1e-12 * sum.norm());
  }
}

}  // namespace
}  // namespace tanktread::stokes
