// Tests of equations that a program adds to the system.

#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "membrane/laws.hpp"
#include "system/capsule.hpp"
#include "system/coupled_motion.hpp"
#include "system/equations/user_equation.hpp"
#include "tests/unit/system/sphere_in_flow.hpp"

namespace tanktread::coupling {
namespace {

constexpr double of_velocity = 1e-8;  // relative error of velocities: residuals of 1e-11, condition numbers of at most 1e3

/// A force of unknown size in a given direction on one control point, which does not move in this direction: W.v = 0, with the virtual work W q.
struct Held : UserEquation {
  struct AtShape : Equation {
    Net work;
    BlockId force;
    AtShape(Net of_unit, BlockId at) : work(std::move(of_unit)), force(at) {}
    void add_sources(const BlockVector& x, Given, Sources& to) const override { to.add_work(x.value(force)(0, 0) * work); }
    void add_residual(const BlockVector&, const Sources&, const SurfaceVelocity& u, Given, BlockVector& r) const override {
      r(force)(0, 0) += dot(work, u.of_points());
    }
  };

  static Net of_unit(Eigen::Index n) {
    Net work = Net::Zero(n, 3);
    work.row(n / 3) << 0.6, -0.5, 0.7;
    return work;
  }
  std::vector<Block> unknowns() const override { return {{.name = "force", .rows = 1, .components = 1, .parity = Parity::scalar, .unit = 0.3}}; }
  std::unique_ptr<const Equation> at(const Net& x, const Layout& all) const override {
    return std::make_unique<AtShape>(of_unit(x.rows()), all.id("force", -1));
  }
};

/// A sphere with an elastic membrane in shear flow, on the coarsest mesh, solved to a relative residual of 1e-11.
struct HeldSphere : SphereInFlow {
  explicit HeldSphere(double ratio) : SphereInFlow(3, "simple shear") {
    parameters.particles.front().material.law = membrane::NeoHookean{2.5};
    parameters.particles.front().viscosity_ratio = ratio;
    parameters.solvers.tolerance = 1e-11;
  }
  Net sheared() const {
    Net x = sphere;
    x.col(0) += 0.3 * sphere.col(2) + 0.1 * sphere.col(1).cwiseProduct(sphere.col(1));
    return x;
  }
};

TEST(UserEquation, ItsUnknownForceActsAsAGivenForceOfThisSizeAndHoldsThePoint) {
  for (const double ratio : {1., 5.}) {
    HeldSphere with(ratio), without(ratio);
    with.parameters.equations.push_back([](const ParticlesAtRest&) { return std::make_shared<const Held>(); });
    Capsule held = with.capsule(), pushed = without.capsule();
    const Net x = with.sheared(), work = Held::of_unit(x.rows());
    Evaluation one = *held.evaluate(x);
    const double force = one.solution().value(one.solution().layout()->id("force", -1))(0, 0);
    EXPECT_GT(std::abs(dot(work, pushed.velocity(x))), 0.01) << ratio;  // the point moves if it is not held
    EXPECT_LT(std::abs(dot(work, one.velocity())), of_velocity) << ratio;
    pushed.set_forces(&Capsule::Forces::contacts, -force * work);
    Evaluation other = *pushed.evaluate(x);
    EXPECT_LT((one.velocity() - other.velocity()).norm(), of_velocity * other.velocity().norm()) << ratio;
    EXPECT_LT((one.load() - other.load()).norm(), of_velocity * other.load().norm()) << ratio;
    EXPECT_LT((one.stresslet() - other.stresslet()).norm(), of_velocity * other.stresslet().norm()) << ratio;
  }
}

/// The displacements of an implicit step satisfy the rows of the equation as velocities do.
TEST(UserEquation, ImplicitStepsContainIt) {
  HeldSphere with(5);
  with.parameters.equations.push_back([](const ParticlesAtRest&) { return std::make_shared<const Held>(); });
  Capsule held = with.capsule();
  CoupledMotion motion(held);
  const Net x = with.sheared(), work = Held::of_unit(x.rows());
  const State y = motion.state_of(x);
  motion.freeze(y);
  motion.linearise(y);
  State r = motion.velocity(y);
  motion.shape(r) += work;  // a part that violates the rows
  constexpr double shift = 0.1, tolerance = 1e-10;
  const State delta = motion.solve(shift, r, tolerance, {});
  const double expected = dot(work, Net(motion.shape(r)));
  EXPECT_NEAR(dot(work, Net(motion.shape(delta))), expected, 1e-6 * expected);  // the small multiple of the unknown in its row
  EXPECT_GT((motion.shape(delta) - motion.shape(r)).norm(), 0.01 * r.norm());
}

}  // namespace
}  // namespace tanktread::coupling
