// Tests of the coupled system: its residual, and that every choice of the blocks that are eliminated gives the same velocity.

#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "membrane/laws.hpp"
#include "system/capsule.hpp"
#include "system/equations/volumes.hpp"
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

/// Layers whose double layer is a given matrix. Records which parts of the sources had rows.
struct MatrixLayers : LayersAt {
  Eigen::MatrixXd dual;
  Net flow;
  int sums = 0;  ///< number of sums of the double layer

  Net ambient() override { return flow; }
  Net of_particles(const Net& load, const Net& density) override {
    EXPECT_EQ(load.size(), 0);
    if (density.size() == 0) return Net::Zero(flow.rows(), 3);
    ++sums;
    const Eigen::VectorXd u = dual * flat(density);
    return as_net(u);
  }
  void add_walls(const FluidWalls::Response&, Net&) override { ADD_FAILURE() << "there are no walls"; }
};

/// v - u = 0, with the density v.
struct Velocities : Equation {
  void add_sources(const BlockVector& x, Given, Sources& to) const override {
    to.add_density(System::particles(x));
  }
  void add_residual(const BlockVector& x, const Sources&, const SurfaceVelocity& u, Given, BlockVector& r) const override {
    System::particles(r) += System::particles(x) - u.control_values();
  }
};

/// Systems of seven points with one volume constraint, by projection or with the multiplier as an unknown.
struct SmallSystem {
  static constexpr int n = 7;
  VolumeProjection volume{Net::Random(n, 3), Net::Random(n, 3), {{.first_point = 0, .n_points = n, .first_element = 0, .n_elements = 0}}};
  std::shared_ptr<MatrixLayers> layers = std::make_shared<MatrixLayers>();

  SmallSystem() { layers->dual = 0.1 * Eigen::MatrixXd::Random(3 * n, 3 * n), layers->flow = Net::Random(n, 3); }

  System system(bool multipliers) const {
    std::vector<Block> blocks{{.name = "velocity", .on = 0, .rows = n}};
    if (multipliers) blocks.push_back({.name = "multipliers of the volumes", .rows = 1, .components = 1, .parity = Parity::scalar});
    const auto layout = std::make_shared<const Layout>(std::move(blocks));
    System::Equations equations;
    equations.push_back(std::make_unique<Velocities>());
    equations.push_back(std::make_unique<VolumeConstraint>(volume, multipliers ? layout.get() : nullptr));
    return {layout, std::move(equations), layers, [](const Net& u) { return u; }};
  }
};

TEST(System, ResidualIsAffineAndVanishesAtTheSolution) {
  const SmallSystem small;
  for (const bool multipliers : {false, true}) {
    const System system = small.system(multipliers);
    const BlockVector right = system.right_hand_side();
    BlockVector x = system.projected(system.of(Net::Random(SmallSystem::n, 3)));
    BlockVector sum = system.residual(x, Given::included);
    sum -= system.residual(x, Given::omitted);
    sum += right;
    EXPECT_LT(sum.norm(), 1e-13) << multipliers;  // round-off of sums of 21 numbers of size 1
    EXPECT_TRUE(system.solve(Krylov({"GMRES"}), right, x, 1e-13).converged) << multipliers;
    EXPECT_LT(system.residual(x, Given::included).norm(), 1e-12 * right.norm()) << multipliers;
    EXPECT_LT(small.volume.multipliers(System::particles(std::as_const(x))).norm(), 1e-12) << multipliers;
  }
}

TEST(System, EliminatedAndKeptMultipliersGiveTheSameUnknowns) {
  const SmallSystem small;
  Net found[2];
  for (const bool multipliers : {false, true}) {
    const System system = small.system(multipliers);
    BlockVector x(system.unknowns());
    ASSERT_TRUE(system.solve(Krylov({"GMRES"}), system.right_hand_side(), x, 1e-13).converged);
    found[multipliers] = System::particles(std::as_const(x));
  }
  EXPECT_LT((found[0] - found[1]).norm(), 1e-11 * found[0].norm());
}

TEST(System, RightHandSideTakesNoSumOfTheDoubleLayer) {
  const SmallSystem small;
  const System system = small.system(false);
  const BlockVector right = system.right_hand_side();
  EXPECT_EQ(small.layers->sums, 0);
  system.residual(right, Given::omitted);
  EXPECT_EQ(small.layers->sums, 1);
}

TEST(System, MultipliersAndProjectionGiveTheSameVelocity) {
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

TEST(System, WithoutConstraintThereAreNoMultipliers) {
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
