// Tests of the viscous load of a membrane (3.10).

#include <numbers>

#include <gtest/gtest.h>

#include "membrane/membrane.hpp"
#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/shapes.hpp"

namespace tanktread::membrane {
namespace viscosity_test {

struct Sphere {
  spline::TMesh mesh = spline::cube(6);
  spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::catmull_clark);
  Net net = surface::resting_shape(space, mesh, {});
  std::vector<int> all;

  Sphere() {
    for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) all.push_back(e);
  }

  /// Returns the viscous load C v (3.10) in the shape x.
  Net load(const SurfaceViscosity& viscosity, const Net& x, const Net& v) const {
    const Membrane membrane(space, net, Materials{{{NeoHookean{1}, {}, viscosity}}, {}});
    ViscousLoad viscous(membrane);
    viscous.update(x, all);
    Net cv;
    viscous.apply(v, cv);
    return cv;
  }
  double power(const SurfaceViscosity& viscosity, const Net& x, const Net& v) const { return v.cwiseProduct(load(viscosity, x, v)).sum(); }
};

/// Returns an ellipsoid, so that no result is right only by symmetry.
Net stretched(const Net& net) { return net * Vec3(1.3, 0.9, 1.1).asDiagonal(); }

TEST(ViscousLoad, OfARigidMotionVanishes) {
  const Sphere sphere;
  const Net x = stretched(sphere.net);
  Mat3 turn;
  turn << 0, -0.3, 0.2, 0.3, 0, -0.7, -0.2, 0.7, 0;
  const Net v = (x * turn.transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3);
  EXPECT_LT(sphere.load({0.7, 1.9}, x, v).norm(), 1e-13 * v.norm());
}

TEST(ViscousLoad, IsSymmetricAndAddsUpToNoForce) {
  const Sphere sphere;
  const Net x = stretched(sphere.net);
  Net v = x, w = x;
  for (Eigen::Index a = 0; a < x.rows(); ++a) {
    v(a, 1) += std::sin(3 * x(a, 0) + x(a, 2));
    w.row(a) << x(a, 2) + x(a, 1), x(a, 1) * x(a, 1), std::cos(x(a, 0) + 1);
  }
  const Net cv = sphere.load({0.7, 1.9}, x, v), cw = sphere.load({0.7, 1.9}, x, w);
  EXPECT_NEAR(w.cwiseProduct(cv).sum(), v.cwiseProduct(cw).sum(), 1e-12 * std::abs(w.cwiseProduct(cv).sum()));
  EXPECT_LT(cv.colwise().sum().norm(), 1e-12 * cv.norm());
}

/// On the unit sphere v = x is a dilatation: d = g, div 2, tau:d = 4 kappa. The rates of strain of v = (-x1/2, -x2/2, x3) along the meridian and the
/// parallel are d1 = 1 - 3/2 cos^2 and d2 = -1/2, so (d1 - d2)^2 = 9/4 sin^4 and d1 + d2 = 1/2 - 3/2 cos^2. The integrals of (d1 - d2)^2 and (d1 +
/// d2)^2 over the sphere are 4 pi x 6/5 and 4 pi x 1/5.
TEST(ViscousLoad, HasTheDissipationOfTheRateOfStrain) {
  const Sphere sphere;
  const double four_pi = 4 * std::numbers::pi, mesh = 1e-3;  // error of the sphere's fit
  EXPECT_NEAR(sphere.power({0.7, 1.9}, sphere.net, sphere.net), four_pi * 4 * 1.9, mesh * four_pi * 4 * 1.9);
  const Net v = sphere.net * Vec3(-0.5, -0.5, 1).asDiagonal();
  EXPECT_NEAR(sphere.power({0.7, 0}, sphere.net, v), four_pi * 0.7 * 1.2, mesh * four_pi);
  EXPECT_NEAR(sphere.power({0, 1.9}, sphere.net, v), four_pi * 1.9 * 0.2, mesh * four_pi);
}

}  // namespace viscosity_test
}  // namespace tanktread::membrane
