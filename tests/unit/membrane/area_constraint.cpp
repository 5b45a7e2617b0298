// Tests of the projection P (4.25) for membranes that are nearly area-incompressible.

#include "membrane/area_constraint.hpp"

#include <gtest/gtest.h>

#include "capsules.hpp"

namespace tanktread::membrane {
namespace {

const Law laws[] = {Skalak{1.3, 40}, EvansSkalak{1.3, 40}};

Membrane with_points(const Sphere& s, const Law& law) { return Membrane(s.space, s.net, Materials{{{law, {}, {}, 1}}, {}}); }

/// Returns the load of the area part of the law only.
Net area_load(const Sphere& s, const Law& law, const Net& x) {
  return with_points(s, law).load(x) - with_points(s, split(law)->shear).load(x);
}

Eigen::VectorXd mobility(Eigen::Index n) { return Eigen::VectorXd::LinSpaced(n, 0.5, 2); }

/// If nothing is stretched, the whole tangent of the area part is D'D.
TEST(AreaConstraint, InvertsTheStiffPartOfTheTangent) {
  const Sphere& s = sphere(3);
  for (const Law& law : laws) {
    AreaConstraint constraint(with_points(s, law), mobility(s.net.rows()));
    constraint.set_shape(s.net);
    constraint.factor(0.7);
    const Net r = random_net(s.net.rows(), 5), p = constraint.apply(r);
    const Net stiff = difference([&](const Net& y) { return area_load(s, law, y); }, s.net, p);
    EXPECT_LT((p + 0.7 * mobility(s.net.rows()).asDiagonal() * stiff - r).norm(), 1e-7 * r.norm());  // accuracy of the differences
  }
}

TEST(AreaConstraint, TransfersTensionsToAnotherShape) {
  const Sphere& s = sphere(3);
  const Net &like = s.net, start = like + 1e-3 * random_net(like.rows(), 6);
  for (const Law& law : laws) {
    AreaConstraint constraint(with_points(s, law), mobility(like.rows()));
    Net x = start;
    constraint.restore_areas(x, like, 1e6);
    EXPECT_LT(area_load(s, law, x).norm(), 1e-4 * area_load(s, law, start).norm());  // there are no tensions at rest
    EXPECT_LT((x - start).norm(), 2 * (like - start).norm());
  }
}

TEST(AreaConstraint, ExistsOnlyWithOneSeparatePointPerElement) {
  const Sphere& s = sphere(3);
  EXPECT_TRUE(AreaConstraint(Membrane(s.space, s.net, laws[0]), mobility(s.net.rows())).empty());
  EXPECT_TRUE(AreaConstraint(with_points(s, NeoHookean{}), mobility(s.net.rows())).empty());
  const Membrane two_points(s.space, s.net, Materials{{{laws[0], {}, {}, 2}}, {}});  // more conditions than displacements
  EXPECT_TRUE(AreaConstraint(two_points, mobility(s.net.rows())).empty());
}

}  // namespace
}  // namespace tanktread::membrane
