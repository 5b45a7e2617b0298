#include "membrane/maxwell_element.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "capsules.hpp"
#include "membrane/membrane.hpp"
#include "quadrature/gauss.hpp"
#include "surface/geometry.hpp"

namespace tanktread::membrane {
namespace {

constexpr double eta = 0.6, kappa = 1.4, time_of_it = 0.5;
constexpr double shear = eta / time_of_it, dilatation = kappa / time_of_it;

MaxwellElement element(const Sphere& s) { return {s.space, s.net, 4, {eta, kappa}, time_of_it}; }

Net stretched(const Net& x) { return x * Eigen::DiagonalMatrix<double, 3>(1.2, 0.9, 1.05); }

TEST(MaxwellElement, HasNoStressInTheShapeThatItStartsWith) {
  const Sphere& s = sphere(3);
  MaxwellElement springs = element(s);
  const Net x = stretched(s.net);
  springs.set_state(x, springs.start(x));
  EXPECT_LT(springs.load().norm(), 1e-13 * shear * x.norm());
  EXPECT_NEAR(springs.energy(), 0, 1e-13);
  EXPECT_LT(springs.rate({}).norm(), 1e-12 * springs.start(x).norm());
}

/// The strain is F P F^T with the deformation gradient F and P = 1 - N N^T. Its eigenvalue 0, along the normal, has no logarithm and is left out.
TEST(MaxwellElement, GivesRefinementTheLogarithmOfItsStrainInSpace) {
  const Sphere& s = sphere(3);
  MaxwellElement springs = element(s);
  springs.set_state(stretched(s.net), springs.start(s.net));
  const auto values = springs.values_at();
  const Eigen::VectorXd& nodes = quadrature::tensor_gauss(4).s;  // nodes of elements at the centre of a face; values between nodes are interpolated
  for (const spline::Site& site : {spline::Site{4, nodes[0], nodes[2]}, {31, nodes[1], nodes[1]}, {49, nodes[3], nodes[0]}}) {
    const Vec3 n = surface::point(s.space, s.net, site).n, stretch(1.2, 0.9, 1.05);
    const Mat3 strain = stretch.asDiagonal() * (Mat3::Identity() - n * n.transpose()) * stretch.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Mat3> pairs(strain);
    Mat3 expected = Mat3::Zero();
    for (int k = 1; k < 3; ++k) expected += std::log(pairs.eigenvalues()[k]) * pairs.eigenvectors().col(k) * pairs.eigenvectors().col(k).transpose();
    ASSERT_EQ(values(site).size(), 9);
    EXPECT_LT((values(site) - expected.reshaped()).norm(), 1e-12);
  }
}

/// At small strains its law has the energy E = int (G |dev e|^2 + K/2 (tr e)^2) dGamma, like every law with the same moduli.
TEST(MaxwellElement, IsAnElasticMembraneForShortTimes) {
  const Sphere& s = sphere(3);
  MaxwellElement springs = element(s);
  const double c = (dilatation / shear - 1) / 2, small = 1e-4;  // K = (1 + 2 C) G of Evans and Skalak
  const Net x = s.net + small * (stretched(s.net) - s.net);
  springs.set_state(x, springs.start(s.net));
  const Membrane elastic(s.space, s.net, EvansSkalak{shear, c});
  const Net load = elastic.load(x);
  EXPECT_LT((springs.load() - load).norm(), 3 * small * load.norm());  // the difference is of second order
  EXPECT_NEAR(springs.energy() / energy(elastic, x), 1, 3 * small);
}

TEST(MaxwellElement, LoadIsTheGradientOfTheEnergy) {
  const Sphere& s = sphere(3);
  MaxwellElement springs = element(s);
  const Net x = stretched(s.net), u = random_net(x.rows(), 3);
  const Eigen::VectorXd q = springs.start(s.net);
  springs.set_state(x, q);
  const double expected = springs.load().cwiseProduct(u).sum(), h = 1e-5;
  const auto at = [&](double step) {
    springs.set_state(x + step * u, q);
    return springs.energy();
  };
  EXPECT_NEAR((at(h) - at(-h)) / (2 * h) / expected, 1, 1e-8);
}

TEST(MaxwellElement, DissipatesTheEnergyOfItsSpringsAtRest) {
  const Sphere& s = sphere(3);
  MaxwellElement springs = element(s);
  const Net x = stretched(s.net);
  const Eigen::VectorXd q = springs.start(s.net);
  springs.set_state(x, q);
  const double heat = springs.dissipation(), h = 1e-5;
  const Eigen::VectorXd rate = springs.rate({});
  EXPECT_GT(heat, 0.1);
  const auto at = [&](double step) {
    springs.set_state(x, q + step * rate);
    return springs.energy();
  };
  EXPECT_NEAR((at(-h) - at(h)) / (2 * h) / heat, 1, 1e-8);
}

/// If a sphere is inflated, J - 1 decays like exp(-t/T), and the energy is K/2 (J - 1)^2 times its area.
TEST(MaxwellElement, RelaxesAChangeOfAreaExponentially) {
  const Sphere& s = sphere(3);
  MaxwellElement springs = element(s);
  const Net x = 1.1 * s.net;
  Eigen::VectorXd q = springs.start(s.net);
  const double h = 0.01 * time_of_it, first = (springs.set_state(x, q), springs.energy());
  const auto rate = [&](const Eigen::VectorXd& at) { return springs.set_state(x, at), springs.rate({}); };
  for (int step = 0; step < 100; ++step) {  // classical Runge-Kutta scheme, error 1e-10
    const Eigen::VectorXd k1 = rate(q), k2 = rate(q + h / 2 * k1), k3 = rate(q + h / 2 * k2), k4 = rate(q + h * k3);
    q += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  springs.set_state(x, q);
  EXPECT_NEAR(first / (dilatation / 2 * std::pow(1.21 - 1, 2) * energy(Membrane(s.space, s.net, SurfaceTension{1}), x)), 1, 1e-12);
  EXPECT_NEAR(springs.energy() / first, std::exp(-2.), 1e-9);
}

/// If the surface moves steadily for many T, the stress is the viscous stress (3.10) with eta_s and kappa_s.
TEST(MaxwellElement, IsViscousForShortRelaxationTimes) {
  const Sphere& s = sphere(3);
  const double fast = 1e-5;
  MaxwellElement springs(s.space, s.net, 4, {eta, kappa}, fast);
  const Net x = stretched(s.net), v = random_net(x.rows(), 4);
  Eigen::VectorXd q = springs.start(x);
  const double h = 1e-6;  // q lags behind the metric by T times its rate
  const Eigen::VectorXd metric_rate = (springs.start(x + h * v) - springs.start(x - h * v)) / (2 * h);
  springs.set_state(x, q - fast * metric_rate);
  const Membrane membrane(s.space, s.net, Materials{{{NeoHookean{1}, {}, {eta, kappa}}}, {}});
  ViscousLoad viscous(membrane);
  std::vector<int> all(s.space.elements.size());
  for (std::size_t e = 0; e < all.size(); ++e) all[e] = static_cast<int>(e);
  viscous.update(x, all);
  Net expected;
  viscous.apply(v, expected);
  EXPECT_LT((springs.load() - expected).norm(), 1e-3 * expected.norm());  // T |d| = 1e-4
  EXPECT_NEAR(springs.dissipation() / expected.cwiseProduct(v).sum(), 1, 1e-3);
}

/// Load and rate of the images of x and q are the images of load and rate, even though the state has no symmetry.
TEST(MaxwellElement, HasTheImagesOfItsSurface) {
  const Sphere& s = sphere(3);
  MaxwellElement springs = element(s);
  const Net* nets[] = {&s.net};
  const surface::Symmetry found = surface::symmetry(s.space, nets, [](const surface::Image&) { return true; });
  ASSERT_EQ(found.order(), 8);
  const Net x = s.net + 0.05 * random_net(s.net.rows(), 5);
  const Eigen::VectorXd q = springs.start(s.net + 0.05 * random_net(s.net.rows(), 6));
  springs.set_state(x, q);
  const Net load = springs.load();
  const Eigen::VectorXd rate = springs.rate({});
  for (const surface::Image& g : found.images()) {
    const auto of_net = [&](const Net& net) {
      Net image(net.rows(), 3);
      for (Eigen::Index a = 0; a < net.rows(); ++a) image.row(g.point[static_cast<std::size_t>(a)]) = net.row(a).cwiseProduct(g.signs.transpose());
      return image;
    };
    const std::vector<std::pair<int, double>> images = springs.images(g);
    const auto of_q = [&](const Eigen::VectorXd& known) {
      Eigen::VectorXd image(known.size());
      for (Eigen::Index i = 0; i < known.size(); ++i) {
        const auto& [to, sign] = images[static_cast<std::size_t>(i)];
        image[to] = sign * known[i];
      }
      return image;
    };
    springs.set_state(of_net(x), of_q(q));
    EXPECT_LT((springs.load() - of_net(load)).norm(), 1e-9 * load.norm()) << g.signs.transpose();  // the fitted sphere is symmetric to 1e-10
    EXPECT_LT((springs.rate({}) - of_q(rate)).norm(), 1e-9 * rate.norm()) << g.signs.transpose();
  }
}

}  // namespace
}  // namespace tanktread::membrane
