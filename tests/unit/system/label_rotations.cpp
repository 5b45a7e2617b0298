// Tests of rotations of the unstressed surface onto itself, which move the material points of a membrane without changing its energy.

#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "system/targets/collocation.hpp"
#include "system/symmetry.hpp"
#include "tests/unit/system/sphere_in_flow.hpp"

namespace tanktread::coupling {
namespace {

struct Ball : SphereInFlow {
  membrane::SymmetricSolver collocation;
  explicit Ball(int n) : SphereInFlow(n, "simple shear"), collocation({}, surface::Symmetry(space.n_points)) {
    collocation.factor(collocation_matrix(space));
  }
  std::optional<Net> rotation(const Net& unstressed, const Net& x, int axis) const {
    const spline::Block all = spline::blocks(std::vector<const spline::Space*>{&space}).front();
    return label_rotation(space, all, unstressed, x, axis, collocation);
  }
  /// Returns the rate of change of the energy of a membrane in the shape x along the displacement rotation(sphere, x, axis), divided by the largest
  /// rate of change along any displacement of equal norm.
  double gain(const Net& x, int axis) const {
    const membrane::Membrane membrane(space, sphere, membrane::NeoHookean{1});
    std::vector<int> elements(space.elements.size());
    std::iota(elements.begin(), elements.end(), 0);
    Net gradient(x.rows(), 3);
    membrane.load(x, elements, gradient);
    const Net way = rotation(sphere, x, axis).value();
    return std::abs(gradient.cwiseProduct(way).sum()) / (gradient.norm() * way.norm());
  }
};

TEST(LabelRotation, OfASphereAtRestIsARotation) {
  const Ball ball(6);
  for (int axis = 0; axis < 3; ++axis) {
    const Net turn = -ball.sphere.rowwise().cross(Vec3::Unit(axis).transpose());
    EXPECT_LT((ball.rotation(ball.sphere, ball.sphere, axis).value() - turn).norm(), 5e-3 * turn.norm());
  }
}

TEST(LabelRotation, DoesNotChangeTheEnergyOfAStretchedMembrane) {
  const auto stretched = [](const Ball& ball) {
    Net x = ball.sphere;
    x.col(0) = 1.5 * ball.sphere.col(0) + 0.4 * ball.sphere.col(2) + 0.2 * ball.sphere.col(1).cwiseAbs2();
    return x;
  };
  const Ball coarse(4), fine(8);
  for (int axis = 0; axis < 3; ++axis) {
    const double there = fine.gain(stretched(fine), axis);
    EXPECT_LT(there, 1e-4);
    EXPECT_LT(there, coarse.gain(stretched(coarse), axis) / 4 + 1e-12);
  }
}

TEST(LabelRotation, OfASpheroidExistsOnlyAboutItsAxis) {
  const Ball ball(6);
  const Net flat = ball.sphere * Vec3(1, 1, 0.6).asDiagonal();
  EXPECT_FALSE(ball.rotation(flat, flat, 0).has_value());
  EXPECT_FALSE(ball.rotation(flat, flat, 1).has_value());
  EXPECT_TRUE(ball.rotation(flat, flat, 2).has_value());
}

}  // namespace
}  // namespace tanktread::coupling
