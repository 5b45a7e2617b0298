// Relaxation rates of the harmonics of spheres in a fluid at rest, compared with Lamb's solution (4.18) for drops and the 2 x 2 system (4.19) of
// capsules.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include "motion/spectrum.hpp"
#include "tests/evolution.hpp"

namespace tanktread {
namespace relaxation_rates_test {

using Pair = Eigen::Vector2d;

/// Returns the rate (4.18) in units of sigma/(mu R).
double drop_rate(int l, double lambda) {
  const double a = (2. * l * l + 4 * l + 3) * lambda + 2. * l * (l + 2), b = 2. * l * l + 1 + 2. * (l * l - 1) * lambda;
  return -(l - 1.) * l * (l + 1) * (l + 2) * (2 * l + 1) * (lambda + 1) / (a * b);
}

/// Returns the slow and the fast rate of (4.19) in units of G/(mu R), for the viscosity ratio 1.
Pair capsule_rates(int l, double dilatation) {
  const double k = dilatation, n = l * (l + 1.);
  Eigen::Matrix2d load, waves;
  load << -4 * k, 2 * k * n, 2 * k, -k * n - (n - 2);
  waves << -(l + 1), l, 1, 1;
  const Pair layer(l / ((2. * l + 1) * (2 * l + 3)), (l + 1.) / ((2. * l + 1) * (2 * l - 1)));
  const Eigen::Matrix2d system = waves * layer.asDiagonal() * waves.inverse() * load;
  const Pair rates = Eigen::EigenSolver<Eigen::Matrix2d>(system).eigenvalues().real();
  return {rates.maxCoeff(), rates.minCoeff()};
}

struct Sphere {
  Evolution scene;
  std::vector<motion::Mode> modes;

  Sphere(std::vector<std::string> settings, int n)
      : scene([&] {
          settings.insert(settings.end(), {"Flow/type=quiescent", "Surface/elements per side=" + std::to_string(n), "Quadrature/tolerance=1e-7"});
          return settings;
        }()) {
    coupling::CoupledMotion& motion = *scene.motion;
    const coupling::State x = motion.start(scene.body().rest);
    coupling::ShapeCoordinates shapes(motion, x, scene.body().symmetry);
    shapes.follow(motion, x);
    motion::SpectrumOptions options;
    options.number = static_cast<int>(shapes.size());
    const coupling::State flux = motion.state_of(scene.capsule->geometry().volume_gradient(scene.body().rest));
    modes = motion::spectrum({motion, shapes, x, {{flux, motion::ModeKind::volume}}}, options, {});
  }

  /// Returns, among the modes with rates within 5 % of `near`, the rate of the mode closest to a displacement by the second harmonic, Y r and grad Y.
  double second_harmonic(double near) const {
    const Net& x = scene.body().rest;
    Eigen::MatrixXd fields(3 * x.rows(), 4);
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const Vec3 r = x.row(i).transpose().normalized();
      const Vec3 slopes[] = {{-r[0], -r[1], 2 * r[2]}, {r[0], -r[1], 0}};  // half of the gradients of two solid harmonics
      for (int k = 0; k < 2; ++k) {
        fields.block<3, 1>(3 * i, 2 * k) = slopes[k].dot(r) * r;
        fields.block<3, 1>(3 * i, 2 * k + 1) = slopes[k] - slopes[k].dot(r) * r;
      }
    }
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(fields);
    double best = std::numeric_limits<double>::quiet_NaN(), least = 0.5;
    for (const motion::Mode& mode : modes) {
      if (std::abs(mode.rate.real() / near - 1) > 0.05) continue;
      const Eigen::VectorXd y = mode.real.numbers();
      const double rest = (y - fields * qr.solve(y)).norm() / y.norm();
      if (rest < least) least = rest, best = mode.rate.real();
    }
    return best;
  }
};

TEST(RelaxationRates, OfTheTwoByTwoSystemAreThoseOfTheSeries) {
  EXPECT_NEAR(capsule_rates(2, 3)[0], -0.24835904, 1e-8);
  EXPECT_NEAR(capsule_rates(2, 3)[1], -2.20878382, 1e-8);
  EXPECT_NEAR(capsule_rates(4, 201)[1], -227.14635, 1e-5);
}

class OfDrops : public testing::TestWithParam<double> {};

TEST_P(OfDrops, ConvergeToLambsSolution) {
  const double lambda = GetParam(), exact = drop_rate(2, lambda);
  const std::vector<std::string> drop = {"Membrane/law=surface tension", "Membrane/surface tension=1",
                                         "Particle/viscosity ratio=" + std::to_string(lambda)};
  const double coarse = std::abs(Sphere(drop, 5).second_harmonic(exact) / exact - 1);
  const double fine = std::abs(Sphere(drop, 10).second_harmonic(exact) / exact - 1);
  EXPECT_LT(fine, 1e-4);
  EXPECT_GT(std::log2(coarse / fine), 3);  // order 2.9 between n = 4 and 8, 3.4 between 6 and 12
}

TEST_P(OfDrops, ConvergeFasterWithLeastSquaresProjection) {
  const double lambda = GetParam(), exact = drop_rate(2, lambda);
  const std::vector<std::string> drop = {"Membrane/law=surface tension", "Membrane/surface tension=1", "Solvers/projection=least squares",
                                         "Particle/viscosity ratio=" + std::to_string(lambda)};
  const double coarse = std::abs(Sphere(drop, 4).second_harmonic(exact) / exact - 1);
  const double fine = std::abs(Sphere(drop, 6).second_harmonic(exact) / exact - 1);
  EXPECT_LT(fine, 1e-4);
  EXPECT_GT(std::log(coarse / fine) / std::log(1.5), 5);
}

TEST(RelaxationRates, OfTranslationsOfADropAreZero) {
  for (const char* projection : {"collocation", "least squares"}) {
    const Sphere sphere({"Membrane/law=surface tension", "Membrane/surface tension=1", "Symmetry/use=none",
                         std::string("Solvers/projection=") + projection}, 3);
    const auto translates = [](const motion::Mode& mode) { return mode.kind == motion::ModeKind::translation; };
    EXPECT_EQ(std::ranges::count_if(sphere.modes, translates), 3) << projection;
    for (const motion::Mode& mode : sphere.modes)
      if (translates(mode)) {
        EXPECT_NEAR(std::abs(mode.rate), 0, 1e-8) << projection;
      }
  }
}

INSTANTIATE_TEST_SUITE_P(RelaxationRates, OfDrops, testing::Values(0.1, 1., 10.));

TEST(RelaxationRates, OfACapsuleAreBothElasticModes) {
  const std::vector<std::string> capsule = {"Membrane/shear modulus=1"};
  const Sphere coarse(capsule, 4), fine(capsule, 8);
  for (const double exact : {capsule_rates(2, 3)[0], capsule_rates(2, 3)[1]}) {
    const double error = std::abs(fine.second_harmonic(exact) / exact - 1);
    EXPECT_LT(error, 3e-4) << exact;
    EXPECT_GT(std::log2(std::abs(coarse.second_harmonic(exact) / exact - 1) / error), 3) << exact << ' ' << error;
  }
}

TEST(RelaxationRates, OfRigidMotionsAndOfTheVolumeAreZeroAndNamed) {
  const Sphere sphere({"Membrane/shear modulus=1", "Symmetry/use=none"}, 3);
  std::map<motion::ModeKind, int> count;
  for (const motion::Mode& mode : sphere.modes) {
    if (mode.kind == motion::ModeKind::shape) continue;
    ++count[mode.kind];
    EXPECT_NEAR(std::abs(mode.rate), 0, 1e-8) << name(mode.kind);
  }
  EXPECT_EQ(count[motion::ModeKind::translation], 3);
  EXPECT_EQ(count[motion::ModeKind::rotation], 3);
  EXPECT_EQ(count[motion::ModeKind::labels], 0);  // for a sphere at rest these modes are the rotations
  EXPECT_EQ(count[motion::ModeKind::volume], 1);
}

TEST(RelaxationRates, ByKrylovSchurAreThoseOfTheWholeJacobian) {
  Evolution run({"Flow/type=quiescent", "Membrane/law=surface tension", "Membrane/surface tension=1", "Surface/elements per side=4"});
  const coupling::State x = run.motion->start(run.body().rest);
  const coupling::ShapeCoordinates shapes(*run.motion, x, run.body().symmetry);
  motion::SpectrumOptions options;
  options.number = 6, options.shift = 1;
  const coupling::State flux = run.motion->state_of(run.capsule->geometry().volume_gradient(run.body().rest));
  const std::vector<motion::Conserved> kept{{flux, motion::ModeKind::volume}};
  const auto all = motion::spectrum({*run.motion, shapes, x, kept}, options, {"GMRES"});
  options.method = "krylov";
  const auto some = motion::spectrum({*run.motion, shapes, x, kept}, options, {"GMRES"});
  ASSERT_EQ(some.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(std::abs(some[k].rate - all[k].rate), 0, 1e-5) << k;
}

}  // namespace relaxation_rates_test
}  // namespace tanktread
