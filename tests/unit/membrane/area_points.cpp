// Tests of laws whose area elasticity is integrated with a separate quadrature (3.13).

#include <cmath>

#include <gtest/gtest.h>

#include "capsules.hpp"

namespace tanktread::membrane {
namespace {

Membrane with_points(const Sphere& s, const Law& law, int area_order) { return Membrane(s.space, s.net, Materials{{{law, {}, {}, area_order}}, {}}); }

const Law stiff[] = {Skalak{1.3, 40}, EvansSkalak{1.3, 40}};

TEST(AreaPoints, PartsOfALawAddUpToIt) {
  for (const Law& law : stiff) {
    const SplitLaw parts = split(law).value();
    EXPECT_EQ(area_modulus(parts.shear), modulus(law) * (std::holds_alternative<Skalak>(law) ? 1 : 0));
    for (const double l1 : {0.7, 1.0, 1.4})
      for (const double l2 : {0.8, 1.0, 1.9})
        EXPECT_NEAR(energy(parts.shear, l1, l2) + energy(Law(parts.area), l1, l2), energy(law, l1, l2), 1e-13 * (1 + energy(law, l1, l2)));
  }
  EXPECT_FALSE(split(NeoHookean{}));
}

TEST(AreaPoints, AsManyAsForTheRestAreTheWholeLaw) {
  const Sphere& s = sphere(3);
  const Net x = deformed(s.net);
  for (const Law& law : stiff) {
    const Membrane whole = with_points(s, law, 0), parts = with_points(s, law, 4);
    EXPECT_NEAR(energy(parts, x) / energy(whole, x), 1, 1e-13);
    EXPECT_LT((parts.load(x) - whole.load(x)).norm(), 1e-12 * whole.load(x).norm());
    EXPECT_NEAR(tension_summary(parts, x).smallest, tension_summary(whole, x).smallest, 1e-12);
    // The reported change of area includes points at which the law with one point is not evaluated.
    EXPECT_GE(tension_summary(with_points(s, law, 1), x).area_change, tension_summary(whole, x).area_change);
    // Its root mean square is evaluated at the points of the rest of the law, whatever the points of the area elasticity.
    EXPECT_NEAR(tension_summary(with_points(s, law, 1), x).rms_area_change, tension_summary(whole, x).rms_area_change, 1e-12);
  }
}

TEST(AreaPoints, LoadIsTheGradientOfTheEnergyAndTangentThatOfTheLoad) {
  const Sphere& s = sphere(3);
  const Net x = deformed(s.net), u = random_net(x.rows(), 31);
  for (const Law& law : stiff) {
    const Membrane membrane = with_points(s, law, 1);
    EXPECT_LT(gradient_error(membrane, x, u), 1e-8);
    EXPECT_LT(tangent_error(membrane, s, x, u), 1e-8);
  }
}

/// A sphere sheared without area change. A membrane that locks is stiffer in proportion to its C.
TEST(AreaPoints, OnePerElementAvoidsLocking) {
  const double c = 1e4;
  std::vector<double> whole, one;
  for (const int n : {4, 8}) {
    const Sphere& s = sphere(n);
    Net x = s.net;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {  // parallels are rotated about x3 by an angle that grows with x3, so areas do not change
      const double angle = 0.3 * x(i, 2), cosine = std::cos(angle), sine = std::sin(angle), x1 = x(i, 0);
      x(i, 0) = cosine * x1 - sine * x(i, 1), x(i, 1) = sine * x1 + cosine * x(i, 1);
    }
    const double shear = energy(Membrane(s.space, s.net, Skalak{1, 0}), x);
    whole.push_back(energy(with_points(s, Skalak{1, c}, 0), x) / shear - 1);
    one.push_back(energy(with_points(s, Skalak{1, c}, 1), x) / shear - 1);
  }
  EXPECT_LT(one[0], whole[0]);
  EXPECT_LT(one[1], whole[1]);
}

}  // namespace
}  // namespace tanktread::membrane
