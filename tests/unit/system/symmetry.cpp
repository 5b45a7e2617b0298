// Tests that only the fundamental part of a symmetric scene is evaluated and solved for, and that the result is the result of the whole scene.

#include <gtest/gtest.h>

#include "system/symmetry.hpp"
#include "tests/states.hpp"
#include "tests/unit/system/sphere_in_flow.hpp"

namespace tanktread::coupling {
namespace symmetry_test {

struct Fixture : SphereInFlow {
  Fixture() : SphereInFlow(4, "simple shear") {
    parameters.particles.front().material.law = membrane::NeoHookean{2.5};
    parameters.quadrature.tolerance = 1e-9;  // quadrature errors need not be symmetric
  }

  surface::Symmetry symmetry() const {
    const Net* nets[] = {&sphere};
    return coupling::symmetry({}, space, nets, stokes::AmbientFlow(flow));
  }

  Capsule capsule(bool reduced) {
    parameters.symmetry = reduced ? symmetry() : surface::Symmetry();
    return SphereInFlow::capsule();
  }

  /// Returns an ellipsoid rotated in the plane of shear, which has the symmetry of the flow.
  Net deformed() const {
    Net x = sphere;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const Vec3 p = sphere.row(i).transpose();
      x.row(i) << 1.2 * p[0] + 0.3 * p[2], 0.9 * p[1] * (1 + 0.1 * p[0] * p[0]), 0.95 * p[2] + 0.1 * p[0];
    }
    return x;
  }
};

TEST(Symmetry, OfFlows) {
  Fixture f;
  const auto found = [&](const char* type) {
    f.flow.type = type;
    return f.symmetry().description();
  };
  const auto rotation = [&](double w1, double w2, double w3) {
    f.flow.gradient = (Mat3() << 0, -w3, w2, w3, 0, -w1, -w2, w1, 0).finished();
    return found("linear");
  };
  EXPECT_EQ(found("simple shear"), "mirror x2 and point symmetry");
  EXPECT_EQ(found("planar hyperbolic"), "mirror x1, mirror x2 and mirror x3");
  EXPECT_EQ(found("quiescent"), "mirror x1, mirror x2 and mirror x3");
  EXPECT_EQ(rotation(0, 0, 1), "mirror x3 and point symmetry");
  EXPECT_EQ(rotation(1, 2, 3), "point symmetry");
}

TEST(Symmetry, IsThatOfTheSameSceneInOtherUnits) {
  Fixture f;
  f.flow.type = "planar hyperbolic";
  for (const double unit : {1.0, 1e-9}) {
    surface::ParticleShape shape;
    shape.radius = unit;
    shape.center = {0.01 * unit, 0, 0};  // off the stagnation point
    f.sphere = surface::resting_shape(f.space, f.mesh, shape);
    EXPECT_EQ(f.symmetry().description(), "mirror x2 and mirror x3") << unit;
  }
}

TEST(Symmetry, OfAParticleOffTheStagnationPointOfAShearFlowIsOnlyTheMirrorPlane) {
  Fixture f;
  surface::ParticleShape shape;
  shape.radius = 1;
  shape.center = {0.3, 0.2, 0.4};  // the flow convects it along x1
  f.sphere = surface::resting_shape(f.space, f.mesh, shape);
  EXPECT_EQ(f.symmetry().description(), "mirror x2");
}

TEST(Symmetry, GivesTheVelocityOfTheWholeSurface) {
  for (const double viscosity_ratio : {1.0, 5.0}) {
    Fixture f;
    f.parameters.particles.front().viscosity_ratio = viscosity_ratio;
    f.parameters.solvers.tolerance = 1e-12;
    const Net x = f.deformed();
    const Net whole = f.capsule(false).velocity(x);
    Capsule reduced = f.capsule(true);
    EXPECT_NEAR((reduced.velocity(x) - whole).cwiseAbs().maxCoeff(), 0, 1e-8 * whole.cwiseAbs().maxCoeff());  // quadrature tolerance 1e-9
  }
}

// A branch of steady shapes keeps systems of different symmetry.
TEST(Symmetry, OfASystemDoesNotChangeWhenAnotherIsConstructed) {
  Fixture f;
  Net x = f.deformed();
  x.col(0) += 0.1 * x.col(1);
  const Net alone = f.capsule(false).velocity(x);
  Capsule whole = f.capsule(false);
  const Capsule reduced = f.capsule(true);
  EXPECT_TRUE(whole.velocity(x) == alone);
}

TEST(Symmetry, GivesTheImplicitStepOfTheWholeSurface) {
  Fixture f;
  const Net x = f.deformed();
  Net steps[2];
  for (const bool reduced : {false, true}) {
    Capsule capsule = f.capsule(reduced);
    const Net v = capsule.velocity(x);
    capsule.freeze(x);
    capsule.linearise(x);
    steps[reduced] = implicit_step(capsule, 0.2, 0.2 * v, 1e-10);
  }
  EXPECT_NEAR((steps[1] - steps[0]).norm(), 0, 1e-4 * steps[0].norm());  // entries of the frozen operator are rounded to 2^-9, 294 entries per row
}

}  // namespace symmetry_test
}  // namespace tanktread::coupling
