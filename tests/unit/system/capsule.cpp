// Tests of the coupled capsule: properties of fluid and membrane together that hold on any mesh.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "system/targets/collocation.hpp"
#include "tests/layers.hpp"
#include "tests/membrane_totals.hpp"
#include "tests/states.hpp"
#include "tests/unit/system/sphere_in_flow.hpp"

namespace tanktread::coupling {
namespace {

/// A unit sphere on the coarsest mesh, in shear flow or in a quiescent fluid.
struct Fixture : SphereInFlow {
  explicit Fixture(const char* type = "simple shear") : SphereInFlow(3, type) {
    parameters.particles.front().material.law = membrane::NeoHookean{2.5};
    parameters.viscosity = 1.7;
  }

  /// Returns a stretched, sheared and bent shape whose volume is not conserved.
  Net deformed() const {
    Net x = sphere;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const Vec3 p = sphere.row(i).transpose();
      x.row(i) << 1.2 * p[0] + 0.3 * p[2], 0.9 * p[1] + 0.1 * p[0] * p[0], 0.95 * p[2] - 0.1 * p[1] * p[0];
    }
    return x;
  }
};

TEST(Capsule, UnstressedMembraneMovesWithTheFlow) {
  Fixture f;
  Capsule capsule = f.capsule();
  const Net v = capsule.velocity(f.sphere);
  for (Eigen::Index i = 0; i < v.rows(); ++i) EXPECT_NEAR((v.row(i) - Eigen::RowVector3d(f.sphere(i, 2), 0, 0)).norm(), 0, 1e-13);
}

TEST(Capsule, StoredEnergyDecreasesInAQuiescentFluid) {
  Fixture f("quiescent");
  Capsule capsule = f.capsule();
  Net x = f.deformed();
  capsule.restore_constraints(x);
  const Net v = capsule.velocity(x);
  Net d;
  capsule.membrane().load(x, [&] {
    std::vector<int> all(f.space.elements.size());
    for (size_t e = 0; e < all.size(); ++e) all[e] = static_cast<int>(e);
    return all;
  }(), d = Net(x.rows(), 3));
  EXPECT_LT(dot(d, v), 0);  // dE/dt
  EXPECT_LT(membrane::energy(capsule.membrane(), x + 1e-3 * v), membrane::energy(capsule.membrane(), x));
}

TEST(Capsule, NoFluxThroughTheSurface) {
  Fixture f;
  for (const auto measure : {stokes::Measure::reference, stokes::Measure::current}) {
    f.parameters.particles.front().measure = measure;
    f.parameters.volume.constraint = VolumeConservation::flux;
    Capsule capsule = f.capsule();
    const Net x = f.deformed(), b = capsule.geometry().volume_gradient(x), v = capsule.velocity(x);
    EXPECT_NEAR(dot(b, v), 0, 1e-13 * b.norm() * v.norm());
  }
}

// The operator is frozen in another shape. Without the volume projection, it would cause a flux through the surface. An implicit step would then
// inflate the capsule, and the tension of the membrane would make it grow.
TEST(Capsule, TheJacobianGivesNoFluxThroughTheSurfaceFarFromTheFrozenShape) {
  for (const double ratio : {1.0, 5.0}) {
    Fixture f;
    f.parameters.particles.front().viscosity_ratio = ratio;
    Capsule capsule = f.capsule();
    capsule.freeze(f.sphere);
    const Net x = f.deformed(), b = capsule.geometry().volume_gradient(x);
    capsule.linearise(x);
    const Net rate = capsule.jacobian().velocity_change(f.sphere, {}).rate;
    EXPECT_NEAR(dot(b, rate), 0, (ratio == 1 ? 1e-13 : 1e-3) * b.norm() * rate.norm()) << ratio;  // the system of ratio 5 is solved to 1e-3
  }
}

TEST(Capsule, ExactConstraintRestoresTheVolumeToRoundOff) {
  Fixture f;
  Capsule capsule = f.capsule();
  Net x = f.sphere * 1.001;  // 0.3 %: more than the volume error of any step
  capsule.restore_constraints(x);
  EXPECT_NEAR(capsule.volume_error(capsule.geometry().volume(x)), 0, std::pow(0.003, 4));  // two Newton iterations square the error twice
}

TEST(Capsule, AVolumeThatCannotBeRestoredGivesNan) {
  Fixture f;
  Capsule capsule = f.capsule();
  Net x = f.sphere * 0.05;  // at this size Newton's first iteration overshoots by a factor of a hundred
  capsule.restore_constraints(x);
  EXPECT_FALSE(x.allFinite());
}

TEST(Capsule, MeasuresOfTheLoadAgreeUpToTheMesh) {
  Fixture f;
  const Net x = f.deformed();
  f.parameters.particles.front().measure = stokes::Measure::reference;
  const Net v0 = f.capsule().velocity(x);
  f.parameters.particles.front().measure = stokes::Measure::current;
  const Net v = f.capsule().velocity(x);
  EXPECT_LT((v - v0).norm(), 0.05 * v.norm());  // the measures project the load differently, on only 56 points
  EXPECT_GT((v - v0).norm(), 0);
}

/// The defect of u is B (v - u), computed without v. A short implicit step corrects u by the difference v - u.
TEST(Capsule, DefectIsTheErrorOfAVelocityTimesTheOperator) {
  for (const double ratio : {1.0, 5.0})
    for (const double viscosity : {0.0, 0.7}) {
      Fixture f;
      f.parameters.particles.front().viscosity_ratio = ratio;
      f.parameters.particles.front().material.viscosity = {viscosity, 2 * viscosity};
      f.parameters.solvers.tolerance = 1e-12;
      Capsule capsule = f.capsule();
      const Net x = f.deformed(), v = capsule.velocity(x);
      CoupledMotion motion(capsule);
      const State state = motion.state_of(x);
      EXPECT_LT(motion.defect(state, motion.state_of(v)).norm(), 1e-10 * v.norm());
      Net w = 0.3 * f.sphere.rowwise().reverse();
      w -= dot(capsule.geometry().volume_gradient(x), w) / dot(capsule.geometry().volume_gradient(x), v + f.sphere) * (v + f.sphere);
      capsule.freeze(x);
      capsule.linearise(x);
      const double shift = 1e-7;
      const State found = motion.correction(shift, motion.defect(state, motion.state_of(v - w)), 1e-8, {}) / shift;
      EXPECT_LT((motion.shape(found) - w).norm(), 0.05 * w.norm()) << ratio << " " << viscosity;  // error of the frozen operator on 56 points
    }
}

TEST(Capsule, AnEvaluationIsSolvedAgainToASmallerError) {
  Fixture f;
  f.parameters.particles.front().viscosity_ratio = 5;
  f.parameters.solvers.tolerance = 1e-12;
  Capsule capsule = f.capsule();
  const Net v = f.capsule().velocity(f.deformed());
  const std::shared_ptr<Evaluation> e = capsule.evaluate_on_demand(f.deformed(), {}, 0);
  e->solve(1e-2);
  EXPECT_GT((e->velocity() - v).norm(), 1e-6 * v.norm());
  e->solve();
  EXPECT_LT((e->velocity() - v).norm(), 1e-10 * v.norm());
  e->solve(1e-2);
  EXPECT_EQ(capsule.counts().evaluations, 2) << "the exact solution also serves as a rough one";
}

TEST(Capsule, VelocityFollowsAFlowThatChangesInTime) {
  Fixture f;
  f.flow.history.emplace();
  f.flow.history->times = {0, 2}, f.flow.history->amplitudes = {1, -1};
  Capsule capsule = f.capsule();
  const Net x = f.deformed(), one = capsule.velocity(x);
  capsule.set_time(1, 0);
  const Net none = capsule.velocity(x);
  capsule.set_time(0, 0);
  EXPECT_LT((capsule.velocity(x) - one).norm(), 1e-13 * one.norm());
  const long before = capsule.counts().evaluations;
  capsule.set_time(0, 0);
  capsule.velocity(x);
  EXPECT_EQ(capsule.counts().evaluations, before) << "the same flow, so nothing is evaluated again";
  capsule.set_time(1.5, 0);
  EXPECT_LT((capsule.velocity(x) - none + 0.5 * (one - none)).norm(), 1e-13 * one.norm()) << "what the flow adds is linear in it";
}

// On the unstressed surface the load vanishes. The omitted part of the Jacobian, (dA/dx) f, vanishes too, so that the Jacobian is exact.
struct JacobianCase {
  const char *frozen_operator, *flow;
  double tolerance;
};
class JacobianOf : public testing::TestWithParam<JacobianCase> {};

TEST_P(JacobianOf, CapsuleIsTheDerivativeOfTheVelocityAtRest) {
  Fixture f;
  f.parameters.solvers.frozen_operator = GetParam().frozen_operator;
  f.flow.type = GetParam().flow;
  f.flow.profile = "round", f.flow.maximum_velocity = 4, f.flow.half_width = 2;
  // The Jacobian omits the derivative of this constraint, so that only directions without flux are tested.
  f.parameters.volume.constraint = VolumeConservation::flux;
  Capsule capsule = f.capsule();
  Net delta(f.sphere.rows(), 3);
  for (Eigen::Index i = 0; i < delta.rows(); ++i) {
    const Vec3 p = f.sphere.row(i).transpose();
    delta.row(i) << p[0] * p[1] + p[2], std::sin(2 * p[2]), p[0] * p[0] - p[1];
  }
  const Net b = capsule.geometry().volume_gradient(f.sphere);
  delta -= dot(b, delta) / dot(b, b) * b;
  capsule.freeze(f.sphere);
  capsule.linearise(f.sphere);
  const double h = 1e-5, shift = 0.7;
  f.parameters.volume.constraint = VolumeConservation::none;
  Capsule free = f.capsule();
  const Net jd = (free.velocity(f.sphere + h * delta) - free.velocity(f.sphere - h * delta)) / (2 * h);
  const Net solved = implicit_step(capsule, shift, delta - shift * jd, 1e-7);
  EXPECT_LT((solved - delta).norm(), GetParam().tolerance * delta.norm());
}

// Entries of the assembled operator are rounded to 2^-9. The error of one node per control point is a few per cent for 56 control points.
INSTANTIATE_TEST_SUITE_P(FrozenOperators, JacobianOf,
                         testing::Values(JacobianCase{"assembled", "simple shear", 4e-3}, JacobianCase{"nodal", "simple shear", 4e-2},
                                         JacobianCase{"assembled", "parabolic", 4e-3}));

TEST(Capsule, VelocityWithAViscosityRatioSatisfiesTheBoundaryIntegralEquation) {
  Fixture f;
  const Net x = f.deformed();
  f.parameters.volume.constraint = VolumeConservation::none;
  f.parameters.quadrature.tolerance = 1e-7;
  f.parameters.solvers.tolerance = 1e-10;
  const Net w = f.capsule().velocity(x);  // v_inf minus the single layer of the load: the right-hand side of (2.4)
  for (const double ratio : {0.2, 5.0})
    for (const char* way : {"assembled", "matrix-free"}) {
      f.parameters.particles.front().viscosity_ratio = ratio;
      f.parameters.solvers.double_layer = way;
      const Net v = f.capsule().velocity(x);
      stokes::DoubleLayer layer(f.space, f.parameters.quadrature);
      Net hv(x.rows(), 3), at_sites(x.rows(), 3), right(x.rows(), 3);
      std::vector<int> all(static_cast<size_t>(x.rows()));
      for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
      layer.apply(x, v, all, hv);
      const Eigen::SparseMatrix<double> r = collocation_matrix(f.space);
      at_sites = r * v, right = r * w;
      EXPECT_LT((at_sites - (1 - ratio) * hv - right).norm(), 1e-8 * right.norm()) << ratio << " " << way;
    }
}

// A drop in a rigidly rotating fluid. A rigid motion causes no viscous stress, so the velocity does not depend on the viscosity ratio.
TEST(Capsule, RigidMotionDoesNotDependOnTheViscosityInside) {
  Fixture f("linear");
  Mat3 spin = Mat3::Zero();
  spin(0, 2) = 0.7, spin(2, 0) = -0.7;
  f.flow.gradient = spin;
  f.parameters.solvers.tolerance = 1e-10;
  for (const double ratio : {0.01, 100.0}) {
    f.parameters.particles.front().viscosity_ratio = ratio;
    const Net v = f.capsule().velocity(f.sphere);
    EXPECT_LT((v - f.sphere * spin.transpose()).norm(), 1e-6 * v.norm()) << ratio;  // a hundred times the tolerance 1e-10, divided by 0.01
  }
}

// A unit sphere under the small strain E. The strain of the membrane is P E P, P = I - n n. Its energy is
// G_s int e:e + (tr e)^2 dGamma = 4 pi G_s 3/5 E:E, because the means of the two terms over the sphere are 7/15 and 2/15. The stresslet is the
// derivative of the energy with respect to E.
TEST(Capsule, StressletOfASmallStrainIsThatOfTheMembrane) {
  Fixture f;
  Capsule capsule = f.capsule();
  const double strain = 1e-3;
  Mat3 e = Mat3::Zero();
  e.diagonal() << 1, -0.4, -0.6;
  e(0, 2) = e(2, 0) = 0.7;
  const auto stresslet = [&](double s) {
    const Net x = f.sphere * (Mat3::Identity() + s * e);
    return Evaluation(capsule, x, Net::Zero(x.rows(), 3)).stresslet();
  };
  const Mat3 s = (stresslet(strain) - stresslet(-strain)) / (2 * strain);
  const double exact = 4 * std::numbers::pi * 1.2 * 2.5;
  EXPECT_LT((s - exact * e).norm(), 2e-3 * exact * e.norm());  // error of the sphere on the coarsest mesh
}

}  // namespace
}  // namespace tanktread::coupling
