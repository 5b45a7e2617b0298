// Membrane under compression. Without bending stiffness, the fastest growing wave is the shortest one of the mesh. With bending stiffness, its
// wavelength does not depend on the mesh. On a uniformly compressed sphere the wave is the lowest mode of the energy's second derivative H with
// respect to the mass matrix. A flat membrane under the tension -T with bending modulus B has the eigenvalues -T k^2 + B k^4: not bounded below if B
// = 0, otherwise lowest at k^2 = T/2B.

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "membrane/mass.hpp"
#include "membrane/membrane.hpp"
#include "tests/assembled_tangent.hpp"
#include "tests/evolution.hpp"
#include "tests/membrane_totals.hpp"

namespace tanktread {
namespace {

/// Returns the wave number of the lowest mode, computed from the work of the tension on it; 0 if no mode is unstable.
double lowest_wave(int n, double bending) {
  const Evolution run({"Surface/elements per side=" + std::to_string(n)});
  const double shrunk = 0.97;
  const Net x = shrunk * run.body().rest;
  const membrane::Law law = membrane::NeoHookean{1};
  const membrane::Membrane plain(run.body().space, run.body().rest, law), stiff(run.body().space, run.body().rest, law, 4, {bending, true});
  const Eigen::MatrixXd tense = assembled_tangent(plain, x), h = assembled_tangent(stiff, x);
  membrane::MassMatrix mass(run.body().space);
  const Eigen::MatrixXd scalar = mass.update(x);
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(h.rows(), h.cols());
  for (Eigen::Index a = 0; a < scalar.rows(); ++a)
    for (Eigen::Index b = 0; b < scalar.cols(); ++b)
      for (int c = 0; c < 3; ++c) m(3 * a + c, 3 * b + c) = scalar(a, b);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(h, m);
  if (modes.eigenvalues()[0] >= 0) return 0;
  const Eigen::VectorXd u = modes.eigenvectors().col(0);
  const double tension = -tension_summary(plain, x).smallest;
  return std::sqrt(std::max(0.0, -u.dot(tense * u) / u.dot(m * u) / tension));
}

TEST(CompressedMembrane, WithoutBendingBucklesAtTheLengthOfTheElements) {
  const double coarse = lowest_wave(4, 0), fine = lowest_wave(5, 0);
  EXPECT_GT(fine, 1.25 * coarse);  // measured: 11.4 and 7.6, which is two elements per wave
  EXPECT_GT(coarse, 6);
}

TEST(CompressedMembrane, WithBendingBucklesAtAPhysicalWavelength) {
  const double coarse = lowest_wave(4, 2e-3), fine = lowest_wave(5, 2e-3);
  EXPECT_GT(coarse, 3);
  EXPECT_NEAR(fine / coarse, 1, 0.05);  // measured: 4.7 and 4.8
}

TEST(CompressedMembrane, WithMoreBendingHasNoShortUnstableWave) { EXPECT_LT(lowest_wave(4, 0.1), 2); }

}  // namespace
}  // namespace tanktread
