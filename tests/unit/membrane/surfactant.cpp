#include "membrane/surfactant.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "capsules.hpp"

namespace tanktread::membrane {
namespace {

SurfactantOptions linear(double elasticity) {
  SurfactantOptions options;
  options.elasticity = elasticity;
  return options;
}

TEST(Surfactant, IsConservedForAnyMotion) {
  const Sphere& s = sphere(3);
  Surfactant surfactant(s.space, s.net, linear(0.2), 1.3, 0.4);
  const Eigen::VectorXd q = Eigen::VectorXd::Ones(s.net.rows()) + 0.3 * random_net(s.net.rows(), 1).col(0);
  surfactant.set_state(deformed(s.net), q);
  const Eigen::VectorXd rate = surfactant.rate(random_net(s.net.rows(), 2));
  EXPECT_GT(rate.cwiseAbs().maxCoeff(), 1);
  EXPECT_NEAR(surfactant.mass(rate), 0, 1e-15 * rate.cwiseAbs().maxCoeff() * std::sqrt(static_cast<double>(rate.size())));  // round-off
  EXPECT_NEAR(surfactant.mass(Eigen::VectorXd::Ones(q.size())), 4 * M_PI, 1e-3);  // area of the mesh
}

TEST(Surfactant, OfAnEvenConcentrationLowersTheTensionOfTheInterface) {
  const Sphere& s = sphere(3);
  const Net load = Membrane(s.space, s.net, SurfaceTension{1.3}).load(s.net);
  Surfactant surfactant(s.space, s.net, linear(0.2), 1.3, 0);
  surfactant.set_state(s.net, Eigen::VectorXd::Ones(s.net.rows()));
  EXPECT_LT((surfactant.load() + 0.2 * load).norm(), 1e-12 * load.norm());
  EXPECT_NEAR(surfactant.extremes().smallest, 1, 1e-12);
  EXPECT_NEAR(surfactant.extremes().largest, 1, 1e-12);
  EXPECT_LT(surfactant.rate(Net::Zero(s.net.rows(), 3)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Surfactant, GivesRefinementItsConcentrationPerMean) {
  const Sphere& s = sphere(3);
  Surfactant surfactant(s.space, s.net, linear(0.2), 1, 0);
  const Net x = 1.5 * s.net;
  const Eigen::VectorXd c = Eigen::VectorXd::Constant(s.net.rows(), 0.3) + 0.1 * s.net.col(0);  // has the mean 0.3
  surfactant.set_state(x, surfactant.contents(x, c));
  const auto values = surfactant.values_at();
  for (const spline::Site& site : {spline::Site{0, 0.2, 0.7}, {30, 0.9, 0.4}, {53, 0, 1}}) {
    ASSERT_EQ(values(site).size(), 1);
    EXPECT_NEAR(values(site)[0], 1 + surface::value(s.space, s.net, site)[0] / 3, 1e-12);
  }
}

/// c = 1 + 0.3 Y(n) with Y = a x^2 + b y^2 - (a + b) z^2, whose axes pass through no control or Gauss point. The extremes of Y are -(a + b) and a.
/// Sampling at points of spacing h would have an error h^2; the interpolation has the order 4.
TEST(Surfactant, HasTheExtremesOfTheSplineSurface) {
  const double a = 1, b = 0.4;
  const Mat3 axes = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const auto error = [&](int n) {
    const Sphere& s = sphere(n);
    const Net fitted = surface::LeastSquaresFit(s.space).fit_image(s.net, [&](const Vec3& x) {
      const Vec3 y = axes * x.normalized();
      return Vec3(1 + 0.3 * (a * y[0] * y[0] + b * y[1] * y[1] - (a + b) * y[2] * y[2]), 0, 0);
    });
    Surfactant surfactant(s.space, s.net, linear(0.2), 1, 0);
    surfactant.set_state(s.net, surfactant.contents(s.net, fitted.col(0)));
    const auto [smallest, largest] = surfactant.extremes();
    return std::max(std::abs(smallest - 1 + 0.3 * (a + b)), std::abs(largest - 1 - 0.3 * a));
  };
  const double coarse = error(4), fine = error(8);
  EXPECT_LT(fine, coarse / 12) << coarse << ' ' << fine;  // between the orders 3 and 4
  EXPECT_LT(fine, 1e-4);
}

TEST(Surfactant, HasTheEquationsOfStateOfItsName) {
  SurfactantOptions langmuir = linear(0.3);
  langmuir.coverage = 0.25;
  EXPECT_DOUBLE_EQ(linear(0.3).tension(2), 0.4);
  EXPECT_DOUBLE_EQ(langmuir.tension(2), 1 + 0.3 * std::log(0.5));
  const double h = 1e-5;  // at low coverage the law is the linear one with elasticity E x
  langmuir.coverage = h;
  EXPECT_NEAR((langmuir.tension(1) - 1) / h, -0.3, 1e-5);
}

TEST(Surfactant, FreeEnergyMinusConcentrationTimesChemicalPotentialIsTheTension) {
  SurfactantOptions langmuir = linear(0.3);
  langmuir.coverage = 0.25;
  const double c = 1.3, h = 1e-5;  // central differences: 1e-11
  for (const SurfactantOptions& state : {linear(0.3), langmuir})
    EXPECT_NEAR(state.free_energy(c) - c * (state.free_energy(c + h) - state.free_energy(c - h)) / (2 * h), state.tension(c), 1e-9);
}

/// Control points transport their surfactant. The equality is not exact on a mesh, because c is projected.
TEST(Surfactant, LoadIsTheGradientOfTheFreeEnergy) {
  const auto error = [](int n) {
    const Sphere& s = sphere(n);
    Surfactant surfactant(s.space, s.net, linear(0.4), 1, 0);
    const Eigen::VectorXd q = Eigen::VectorXd::Ones(s.net.rows()) + 0.3 * s.net.col(2);
    const Net x = deformed(s.net), u = deformed(x) - x;
    const double h = 1e-4;
    const auto energy = [&](double part) {
      surfactant.set_state(x + part * u, q);
      return surfactant.energy();
    };
    const double slope = (energy(h) - energy(-h)) / (2 * h);
    surfactant.set_state(x, q);
    return std::abs(inner(surfactant.load(), u) / slope - 1);
  };
  const double coarse = error(4), fine = error(8);
  EXPECT_LT(fine, 1e-4);
  EXPECT_LT(fine, coarse / 4) << coarse << ' ' << fine;
}

TEST(Surfactant, WithoutRemainingTensionIsAFailureThatStatesTheConcentration) {
  const Sphere& s = sphere(3);
  Surfactant surfactant(s.space, s.net, linear(0.4), 1, 0);
  EXPECT_THROW(surfactant.set_state(s.net, Eigen::VectorXd::Constant(s.net.rows(), 2.6)), RunFailure);
}

}  // namespace
}  // namespace tanktread::membrane
