// Tests of the block system for velocities: every choice of the blocks that are eliminated gives the same velocity.

#include <gtest/gtest.h>

#include "membrane/laws.hpp"
#include "system/capsule.hpp"
#include "tests/unit/system/sphere_in_flow.hpp"

namespace tanktread::coupling {
namespace {

constexpr double of_residual = 1e-8;  // relative error of velocities: residuals of 1e-11, condition numbers of at most 1e3

/// A sphere with an elastic membrane in shear flow, on the coarsest mesh, solved to a relative residual of 1e-11.
struct Sphere : SphereInFlow {
  Sphere(double ratio, const char* volume) : SphereInFlow(3, "simple shear") {
    parameters.particles.front().material.law = membrane::NeoHookean{2.5};
    parameters.particles.front().viscosity_ratio = ratio;
    parameters.solvers.volume = volume;
    parameters.solvers.tolerance = 1e-11;
  }

  Net sheared() const {
    Net x = sphere;
    x.col(0) += 0.3 * sphere.col(2) + 0.1 * sphere.col(1).cwiseProduct(sphere.col(1));
    return x;
  }
};

TEST(BlockSystem, MultipliersAndProjectionGiveTheSameVelocity) {
  for (const double ratio : {0.2, 1.0, 5.0}) {
    Sphere eliminated(ratio, "projection"), kept(ratio, "multipliers");
    Capsule by_projection = eliminated.capsule(), by_multipliers = kept.capsule();
    const Net x = eliminated.sheared(), v = by_projection.velocity(x);
    EXPECT_LT((by_multipliers.velocity(x) - v).norm(), of_residual * v.norm()) << ratio;
    Evaluation one = *by_projection.evaluate(x), other = *by_multipliers.evaluate(x);  // a pressure is no load on the membrane
    EXPECT_LT((other.load() - one.load()).norm(), of_residual * one.load().norm()) << ratio;
    EXPECT_LT((other.stresslet() - one.stresslet()).norm(), of_residual * one.stresslet().norm()) << ratio;
    EXPECT_GT(by_multipliers.counts().velocity_iterations, 0) << ratio;  // also at ratio 1, where the projection needs no system
    EXPECT_EQ(by_projection.counts().velocity_iterations > 0, ratio != 1) << ratio;
  }
}

TEST(BlockSystem, WithoutConstraintThereAreNoMultipliers) {
  for (const double ratio : {1., 5.}) {
    Sphere eliminated(ratio, "projection"), kept(ratio, "multipliers");
    for (Sphere* one : {&eliminated, &kept}) one->parameters.volume.constraint = VolumeConservation::none;
    const Net x = eliminated.sheared();
    Capsule capsule = kept.capsule();
    EXPECT_EQ(capsule.velocity(x), eliminated.capsule().velocity(x)) << ratio;
    EXPECT_EQ(capsule.counts().velocity_solves > 0, ratio != 1) << ratio;
  }
}

}  // namespace
}  // namespace tanktread::coupling
