// Tests of the motion of control points of a drop. The normal motion is determined by physics, the tangential motion is a choice.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "deck/section.hpp"
#include "system/targets/collocation.hpp"
#include "tests/states.hpp"
#include "tests/unit/system/sphere_in_flow.hpp"

namespace tanktread::coupling {
namespace {

struct Drop : SphereInFlow {
  explicit Drop(int elements_per_side = 3) : SphereInFlow(elements_per_side, "planar hyperbolic") {
    parameters.particles.front().material.law = membrane::SurfaceTension{5};
    parameters.particles.front().measure = stokes::Measure::current;
    parameters.particles.front().interface_speed = 1;
  }
  Net velocity(MeshMotion motion, const Net& x) {
    parameters.particles.front().interface_motion = motion;
    return capsule().velocity(x);
  }
  /// Returns the largest normal and tangential components at the sites.
  std::pair<double, double> components(const Net& x, const Net& v) const {
    double across = 0, along = 0;
    for (const auto& sites : space.collocation) {
      const Vec3 n = surface::point(space, x, sites.front()).n, u = surface::value(space, v, sites.front());
      across = std::max(across, std::abs(n.dot(u)));
      along = std::max(along, (u - n * n.dot(u)).norm());
    }
    return {across, along};
  }
};

TEST(InterfaceMotion, AllMotionsHaveTheSameNormalVelocity) {
  Drop drop;
  drop.parameters.volume.constraint = VolumeConservation::none;
  Net x = drop.sphere;
  x.col(0) *= 1.2, x.col(2) *= 0.9;
  const Net material = drop.velocity(MeshMotion::material, x);
  for (const MeshMotion motion : {MeshMotion::normal, MeshMotion::relaxed}) {
    const Net difference = drop.velocity(motion, x) - material;
    const auto [across, along] = drop.components(x, difference);
    EXPECT_LT(across, 1e-13) << deck::word(mesh_motions, motion);  // projected and interpolated at the sites that are compared
    EXPECT_GT(along, 1e-2) << deck::word(mesh_motions, motion);
  }
}

TEST(InterfaceMotion, NormalMotionHasNoTangentialPart) {
  Drop drop;
  drop.parameters.volume.constraint = VolumeConservation::none;
  const Net v = drop.velocity(MeshMotion::normal, drop.sphere);
  const auto [across, along] = drop.components(drop.sphere, v);
  EXPECT_GT(across, 0.1);
  EXPECT_LT(along, 1e-10);  // round-off of the interpolation
}

// A flow that stretches a drop along its axes stretches its mesh. Without tension the fluid has the velocity of the flow.
TEST(InterfaceMotion, AFlowThatStretchesTheDropStretchesARelaxedMesh) {
  for (const Vec3& axes : {Vec3(1, 1, 1), Vec3(1.5, 1, 0.8)}) {
    std::vector<double> errors;
    for (const int elements : {3, 6}) {
      Drop drop(elements);
      drop.flow.type = "linear";
      drop.flow.gradient = Vec3(1, 0.5, -1.5).asDiagonal();
      drop.parameters.volume.constraint = VolumeConservation::none;
      drop.parameters.particles.front().material.law = membrane::SurfaceTension{1e-9};
      drop.parameters.particles.front().interface_speed = 0;
      const Net x = drop.sphere * axes.asDiagonal(), v = x * *drop.flow.gradient;
      errors.push_back((drop.velocity(MeshMotion::relaxed, x) - v).norm() / v.norm());
    }
    EXPECT_LT(errors[0], 0.06);
    EXPECT_LT(errors[1], errors[0] / 3);  // integrals over the surface by its sites: order 2
  }
}

// The stresslet of a spherical drop in a straining flow E, S = 2 mu E V 5 (lambda - 1)/(2 lambda + 3) (Batchelor 1970, section 5), does not depend on
// the constant surface tension. It must not depend on the tangential motion of the control points either.
TEST(InterfaceMotion, StressletDoesNotDependOnTheMotionOfTheMesh) {
  SphereInFlow drop(6, "planar hyperbolic");
  drop.parameters.particles.front().material.law = membrane::SurfaceTension{5};
  drop.parameters.particles.front().measure = stokes::Measure::current;
  drop.parameters.particles.front().interface_speed = 1;
  drop.parameters.quadrature.tolerance = 1e-6;
  for (const double ratio : {0.1, 10.0})
    for (const MeshMotion motion : {MeshMotion::material, MeshMotion::normal, MeshMotion::relaxed}) {
      drop.parameters.particles.front().viscosity_ratio = ratio;
      drop.parameters.particles.front().interface_motion = motion;
      Capsule capsule = drop.capsule();
      const Mat3 s = capsule.evaluate(drop.sphere)->stresslet();
      const double exact = 2 * 4 * std::numbers::pi / 3 * 5 * (ratio - 1) / (2 * ratio + 3);
      EXPECT_NEAR(s(0, 0) / exact, 1, 1e-4) << ratio << " " << deck::word(mesh_motions, motion);  // error of the sphere's mesh
      EXPECT_NEAR(s(2, 2) / exact, -1, 1e-4) << ratio << " " << deck::word(mesh_motions, motion);
    }
}

// If control points slide along an interface, its normals turn at these points, and with them the pressure jump across it. A pressure causes no flow
// at any shape, but the layer that is frozen at the earlier shape computes a velocity from the turned pressure. With this velocity, the error of the
// Jacobian would be 20 times the true change, which is due only to the mesh of the sphere.
TEST(InterfaceMotion, TheJacobianOfPointsThatSlideContainsNoFlowByPressure) {
  Drop drop;
  drop.flow.type = "quiescent";
  drop.parameters.particles.front().interface_motion = MeshMotion::relaxed;
  const Net& x = drop.sphere;
  Net slide = -(x.col(0).asDiagonal() * x);
  slide.col(0).array() += 1;
  for (const char* frozen : {"nodal", "assembled"}) {
    drop.parameters.solvers.frozen_operator = frozen;
    Capsule capsule = drop.capsule();
    const double aside = 1e-4;
    const Net found = (capsule.evaluate(x + aside * slide)->fluid_velocity() - capsule.evaluate(x - aside * slide)->fluid_velocity()) / (2 * aside);
    capsule.velocity(x);
    capsule.freeze(x);
    capsule.linearise(x);
    const CapsuleJacobian::RateChange change = capsule.jacobian().velocity_change(slide, {});
    EXPECT_LT((change.rate + change.slip - found).norm(), 0.3 * found.norm()) << frozen;  // error of the frozen operator on 56 points
  }
}

TEST(InterfaceMotion, TheJacobianOfTheFluidVelocityGivesNoFluxFarFromTheFrozenShape) {
  Drop drop;
  drop.parameters.particles.front().interface_motion = MeshMotion::relaxed;
  Capsule capsule = drop.capsule();
  capsule.freeze(drop.sphere);
  const Net x = drop.sphere * Vec3(1.4, 1, 0.7).asDiagonal(), b = capsule.geometry().volume_gradient(x);
  capsule.velocity(x);
  capsule.linearise(x);
  const CapsuleJacobian::RateChange change = capsule.jacobian().velocity_change(drop.sphere, {});
  const Net fluid = change.rate + change.slip;
  EXPECT_NEAR(dot(b, fluid), 0, 1e-12 * b.norm() * fluid.norm());  // round-off
}

TEST(InterfaceMotion, PlainPolesHaveTheNormalOfTheElementsAroundThem) {
  Drop drop;
  const spline::PolarMesh polar{8, 6, spline::PoleRule::plain};
  drop.space = spline::space(polar);
  drop.sphere = surface::resting_shape(drop.space, polar, 2, {});
  drop.parameters.volume.constraint = VolumeConservation::none;
  for (const MeshMotion motion : {MeshMotion::normal, MeshMotion::relaxed}) {
    const Net v = drop.velocity(motion, drop.sphere);
    ASSERT_TRUE(v.allFinite()) << deck::word(mesh_motions, motion);
    for (const auto& sites : drop.space.collocation)
      if (sites.size() > 4) {  // a pole, near which the flow is (x1, 0, -x3)
        const Vec3 x = surface::value(drop.space, drop.sphere, sites.front()), u = surface::value(drop.space, v, sites.front());
        EXPECT_LT(u.head<2>().norm(), 1e-10 * std::abs(u[2])) << deck::word(mesh_motions, motion);  // round-off
        EXPECT_LT(u[2] * x[2], -0.1) << deck::word(mesh_motions, motion);
      }
  }
}

// In an affine flow with the gradient L, a drop that is shifted by d moves like the drop at the origin, plus the uniform velocity L d. All motions of
// the control points must satisfy this.
TEST(InterfaceMotion, AFlowThatTranslatesTheDropTranslatesItsMesh) {
  Drop drop;
  drop.flow.type = "linear";
  drop.flow.gradient = (Mat3() << 0.3, -0.2, 1, 0.1, -0.4, 0.2, -0.3, 0.5, 0.1).finished();
  Net x = drop.sphere;
  x.col(0) *= 1.2, x.col(2) *= 0.9;
  const Eigen::RowVector3d away(2, -3, 10), carried = away * drop.flow.gradient->transpose();
  for (const MeshMotion motion : {MeshMotion::material, MeshMotion::normal, MeshMotion::relaxed}) {
    const Net here = drop.velocity(motion, x), there = drop.velocity(motion, x.rowwise() + away);
    EXPECT_LT(((there.rowwise() - carried) - here).norm(), 1e-12 * there.norm()) << deck::word(mesh_motions, motion);  // round-off
  }
}

// If the rotation W is added to the gradient of the flow, W x is added to the velocity of the control points, so the mesh rotates with the drop. For
// the motions `normal` and `relaxed` this holds for elongated drops only: see the next test.
TEST(InterfaceMotion, AFlowThatRotatesTheDropRotatesItsMesh) {
  Drop drop;
  drop.flow.type = "linear";
  const Mat3 strain = (Mat3() << 0.3, -0.2, 1, 0.1, -0.4, 0.2, -0.3, 0.5, 0.1).finished();
  const Mat3 turns = (Mat3() << 0, -0.7, 2, 0.7, 0, 0.4, -2, -0.4, 0).finished();
  Net x = drop.sphere;
  x.col(0) *= 2, x.col(2) *= 0.5;
  x = x.rowwise() + Eigen::RowVector3d(0.4, -1, 2);
  const auto velocity = [&](MeshMotion motion, const Net& shape, const Mat3& gradient) {
    drop.flow.gradient = gradient;
    return drop.velocity(motion, shape);
  };
  for (const MeshMotion motion : {MeshMotion::material, MeshMotion::normal, MeshMotion::relaxed}) {
    const Net held = velocity(motion, x, strain), turned = velocity(motion, x, strain + turns);
    EXPECT_LT((turned - x * turns.transpose() - held).norm(), 1e-12 * turned.norm()) << deck::word(mesh_motions, motion);  // round-off
  }
  const Net carried = velocity(MeshMotion::material, drop.sphere, strain + turns) - velocity(MeshMotion::material, drop.sphere, strain);
  EXPECT_LT((carried - drop.sphere * turns.transpose()).norm(), 1e-12 * carried.norm());  // round-off
}

// A sphere does not change if it rotates. Its mesh therefore stays at rest.
TEST(InterfaceMotion, AFlowThatRotatesASphereDoesNotRotateItsMesh) {
  Drop drop;
  drop.flow.type = "linear";
  drop.parameters.volume.constraint = VolumeConservation::none;
  const Mat3 turns = (Mat3() << 0, -0.7, 2, 0.7, 0, 0.4, -2, -0.4, 0).finished();
  drop.flow.gradient = turns;
  for (const MeshMotion motion : {MeshMotion::normal, MeshMotion::relaxed})
    EXPECT_LT(drop.velocity(motion, drop.sphere).norm(), 1e-2 * (drop.sphere * turns.transpose()).norm())
        << deck::word(mesh_motions, motion);  // mesh error
  // A mesh whose points crowd on one side: their mean is not the centre.
  Net crowded = drop.sphere;
  for (auto point : crowded.rowwise()) {
    const double radius = point.norm();
    point[0] += 0.3 * radius;
    point *= radius / point.norm();
  }
  ASSERT_GT(crowded.colwise().mean()[0], 0.15);
  EXPECT_LT(drop.velocity(MeshMotion::normal, crowded).norm(), 0.1 * (crowded * turns.transpose()).norm());  // a sphere to a few hundredths
}

// A purely tangential velocity belongs to a steady shape.
TEST(InterfaceMotion, TheMeshOfASteadyShapeIsAtRest) {
  Drop drop;
  Net x = drop.sphere;
  x.col(0) *= 1.5;
  drop.flow.type = "linear";
  const Mat3 shear = (Mat3() << 0, 0, 2.25, 0, 0, 0, -1, 0, 0).finished();  // tank-treads along the surface of this ellipsoid
  drop.flow.gradient = shear;
  drop.parameters.volume.constraint = VolumeConservation::none;
  drop.parameters.particles.front().material.law = membrane::SurfaceTension{1e-9};
  EXPECT_LT(drop.velocity(MeshMotion::normal, x).norm(), 5e-3 * (x * shear.transpose()).norm());  // discretisation error of this coarse mesh, 4e-3
}

TEST(InterfaceMotion, TheJacobianIncludesTheRigidMotionOfTheMesh) {
  Drop drop;
  drop.flow.type = "linear";
  drop.flow.gradient = (Mat3() << 0.3, -0.2, 1, 0.1, -0.4, 0.2, -0.3, 0.5, 0.1).finished();
  const Net moved = Eigen::RowVector3d(0.3, -0.1, 0.2).replicate(drop.sphere.rows(), 1);
  for (const MeshMotion motion : {MeshMotion::normal, MeshMotion::relaxed}) {
    drop.parameters.particles.front().interface_motion = motion;
    Capsule capsule = drop.capsule();
    capsule.freeze(drop.sphere);
    const Net change = derivative_along(capsule, drop.sphere, Net::Zero(moved.rows(), 3), moved);
    // The normals do not turn, but round-off in their difference is divided by a step of about 1e-6.
    EXPECT_LT((change - moved * drop.flow.gradient->transpose()).norm(), 1e-7 * change.norm()) << deck::word(mesh_motions, motion);
  }
}

// The Jacobian includes the changes of the normals and of the rigid motion of the shape. The change `delta` is not symmetric about the axes, so that
// the shape also rotates. The interface has almost no tension, so that the change of the fluid velocity is known.
TEST(InterfaceMotion, TheJacobianIncludesTheRotationOfNormalsAndTheMotionOfTheShape) {
  Drop drop;
  drop.flow.type = "linear";
  drop.flow.gradient = Vec3(1, 0.5, -1.5).asDiagonal();
  drop.parameters.volume.constraint = VolumeConservation::none;
  drop.parameters.particles.front().material.law = membrane::SurfaceTension{1e-9};
  Net x = drop.sphere, delta = x;
  x.col(0) *= 1.5, x.col(2) *= 0.8;
  for (Eigen::Index i = 0; i < x.rows(); ++i) delta.row(i) *= std::pow(drop.sphere(i, 0), 2) + drop.sphere(i, 0) * drop.sphere(i, 2);
  for (const MeshMotion motion : {MeshMotion::normal, MeshMotion::relaxed}) {
    drop.parameters.particles.front().interface_motion = motion;
    Capsule capsule = drop.capsule();
    capsule.freeze(x);
    constexpr double aside = 1e-4;
    const Net change = (capsule.velocity(x + aside * delta) - capsule.velocity(x - aside * delta)) / (2 * aside);
    const Net v = capsule.velocity(x), known = derivative_along(capsule, x, v, delta);
    EXPECT_LT((known - change).norm(), 1e-5 * change.norm()) << deck::word(mesh_motions, motion);  // error of the finite differences
    Capsule resumed = drop.capsule();  // has not evaluated the velocity yet
    resumed.freeze(x);
    EXPECT_LT((derivative_along(resumed, x, v, delta) - known).norm(), 1e-12 * known.norm()) << deck::word(mesh_motions, motion);
  }
}

// An elastic surface that is uniformly inflated or deflated has a uniform tension, and no tangential force acts on the mesh.
TEST(InterfaceMotion, OnlyTangentialForcesMoveTheMesh) {
  Drop drop;
  drop.flow.type = "quiescent";
  drop.parameters.volume.constraint = VolumeConservation::none;
  drop.parameters.particles.front().material.law = membrane::SurfaceTension{1e-9};
  drop.sphere.col(0) *= 2;
  const Net drawn = drop.velocity(MeshMotion::relaxed, drop.sphere * Vec3(1.25, 1, 1).asDiagonal());
  for (const double size : {0.8, 1.25})
    EXPECT_LT(drop.velocity(MeshMotion::relaxed, size * drop.sphere).norm(), 0.25 * drawn.norm()) << size;  // error of this coarse mesh
}

TEST(InterfaceMotion, RelaxedMeshReturnsToItsRestingShape) {
  Drop drop;
  drop.flow.type = "quiescent";
  // Moves the control points of a sphere along it. The surface remains a sphere, and the fluid is at rest except for the discretisation error.
  Net x = drop.sphere;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double turn = 0.2 * drop.sphere(i, 2);
    x.row(i) << std::cos(turn) * drop.sphere(i, 0) - std::sin(turn) * drop.sphere(i, 1),
        std::sin(turn) * drop.sphere(i, 0) + std::cos(turn) * drop.sphere(i, 1), drop.sphere(i, 2);
  }
  const membrane::Membrane mesh(drop.space, drop.sphere, membrane::NeoHookean{1});
  EXPECT_LT(mesh.load(x).cwiseProduct(drop.velocity(MeshMotion::relaxed, x)).sum(), 0);  // the energy of the mesh decreases
}

}  // namespace
}  // namespace tanktread::coupling
