// Nearly spherical drop with a viscous interface in a slow linear flow: its steady shape and the velocity on it (3.28). The velocity is linear in the
// flow and in the disturbance of the shape. So both results follow from the velocities of a sphere in the flow and of a disturbed sphere in a fluid
// at rest.

#include <cmath>
#include <ostream>

#include <gtest/gtest.h>

#include "membrane/symmetric_solver.hpp"
#include "quadrature/gauss.hpp"
#include "surface/geometry.hpp"
#include "system/targets/collocation.hpp"
#include "tests/evolution.hpp"

namespace tanktread {
namespace {

struct Case {
  double viscosity_ratio, shear, dilatational;  ///< lambda, B_s, B_k
  const char *flow, *motion;
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.flow << ", lambda " << c.viscosity_ratio << ", B_s " << c.shear << ", B_k " << c.dilatational << ", mesh " << c.motion;
}

/// Coefficients of Y n and grad_s Y/2 in a field on the sphere; mu = R_C = sigma = 1.
struct Coefficients {
  double normal = 0, tangential = 0;
};

class Drop {
 public:
  Drop(const Case& c, const char* flow, const Mat3& strain)
      : scene_({std::string("Flow/type=") + flow, "Membrane/law=surface tension", "Membrane/surface tension=1", "Surface/elements per side=6",
                "Particle/viscosity ratio=" + std::to_string(c.viscosity_ratio), "Membrane/shear viscosity=" + std::to_string(c.shear),
                "Membrane/dilatational viscosity=" + std::to_string(c.dilatational), std::string("Interface/motion=") + c.motion,
                "Solvers/projection=least squares", "Quadrature/tolerance=1e-7", "Symmetry/use=none"}),
        strain_(strain) {}

  static Mat3 strain(const Evolution& scene) {
    const Mat3 gradient = scene.body().flow.gradient(Vec3::Zero());
    return (gradient + gradient.transpose()) / 2;
  }

  const Evolution& scene() const { return scene_; }

  /// Returns the coefficients by least squares on the sphere, where the integrals of the squares of Y and grad_s Y have the ratio 1 : 6.
  Coefficients coefficients(const Net& field) const {
    Coefficients sum;
    double square = 0;
    const spline::Space& space = scene_.body().space;
    const quadrature::TensorRule& rule = quadrature::tensor_gauss(5);
    for (int e = 0; e < static_cast<int>(space.elements.size()); ++e)
      for (int q = 0; q < rule.size(); ++q) {
        const spline::Site site{e, rule.s[q], rule.t[q]};
        const surface::Point p = surface::point(space, scene_.body().rest, site);
        const Vec3 v = surface::value(space, field, site), along = 2 * (strain_ * p.n - p.n.dot(strain_ * p.n) * p.n);
        const double area = rule.weights[q] * p.jacobian, y = p.n.dot(strain_ * p.n);
        sum.normal += area * y * v.dot(p.n), sum.tangential += area * v.dot(along) / 3;
        square += area * y * y;
      }
    return {sum.normal / square, sum.tangential / square};
  }

  Coefficients at_rest() { return of(scene_.body().rest); }

  /// Returns the derivative of the coefficients with respect to the amplitude f of Y in the shape r = 1 + f Y.
  Coefficients response() {
    constexpr double f = 1e-3;  // central differences have an error of order f^2
    const spline::Space& space = scene_.body().space;
    Net change(space.n_points, 3);
    for (int i = 0; i < space.n_points; ++i) {
      const Vec3 n = surface::value(space, scene_.body().rest, space.collocation[static_cast<std::size_t>(i)].front()).normalized();
      change.row(i) = n.dot(strain_ * n) * n.transpose();
    }
    membrane::SymmetricSolver collocation;
    collocation.factor(coupling::collocation_matrix(space));
    change = f * collocation.solve(change);
    const double apart = 2 * coefficients(change).normal;  // difference of the amplitudes of the two spline shapes
    const Coefficients more = of(scene_.body().rest + change), less = of(scene_.body().rest - change);
    return {(more.normal - less.normal) / apart, (more.tangential - less.tangential) / apart};
  }

 private:
  /// Returns the normal coefficient of the velocity of the mesh, whose normal part is the fluid velocity, and the tangential coefficient of the fluid
  /// velocity.
  Coefficients of(const Net& x) {
    return {coefficients(scene_.capsule->velocity(x)).normal, coefficients(scene_.capsule->evaluate(x)->fluid_velocity()).tangential};
  }

  Evolution scene_;
  Mat3 strain_;
};

class ViscousInterface : public testing::TestWithParam<Case> {};

TEST_P(ViscousInterface, OfADropInASlowFlowHasTheSteadyShapeOfSmallDeformationTheory) {
  const Case& c = GetParam();
  const Mat3 strain = Drop::strain(Evolution({std::string("Flow/type=") + c.flow}));
  const Coefficients flow = Drop(c, c.flow, strain).at_rest(), shape = Drop(c, "quiescent", strain).response();
  const double f = -flow.normal / shape.normal, w = flow.tangential + f * shape.tangential;

  const double w_exact = 5 / (5 + 5 * c.viscosity_ratio + 6 * c.dilatational + 4 * c.shear);
  const double f_exact = (5 + (3 + 4.5 * c.viscosity_ratio + 6 * c.dilatational) * w_exact) / 4;
  EXPECT_NEAR(f / f_exact, 1, 1e-4);  // errors of the mesh are at most 8e-5 here and 1.9e-4 below
  EXPECT_NEAR(w / w_exact, 1, 3e-4);
}

INSTANTIATE_TEST_SUITE_P(Drops, ViscousInterface,
                         testing::Values(Case{1, 0, 0, "simple shear", "relaxed"}, Case{1, 1, 0, "simple shear", "relaxed"},
                                         Case{1, 0, 1, "simple shear", "normal"}, Case{0.2, 2, 0.5, "simple shear", "material"},
                                         Case{5, 0.5, 4, "simple shear", "relaxed"}, Case{1, 3, 0.2, "uniaxial extension", "relaxed"},
                                         Case{0.2, 0, 2, "uniaxial extension", "normal"}, Case{5, 2, 1, "uniaxial extension", "material"}));

}  // namespace
}  // namespace tanktread
