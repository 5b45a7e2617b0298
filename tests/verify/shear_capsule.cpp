// Neo-Hookean capsule in simple shear, Ca = 0.3, compared with a spherical-harmonic solution of the same equations (errors: 3e-7 in D, 0.01 degrees
// in the inclination). Steps have the tolerance 1e-6. At n = 6, a ten times smaller tolerance changes D by only 3e-6, so the remaining error is due
// to the mesh.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/evolution.hpp"

namespace tanktread {
namespace {

struct Outcome {
  double error = 0;        ///< larger one of the errors of taylor_inertia at t = 3 and t = 7.5
  double inclination = 0;  ///< inclination at t = 7.5, degrees
};

Outcome outcome(int n) {
  Evolution run({"Flow/type=simple shear", "Membrane/law=neo-Hookean", "Membrane/capillary number=0.3", "Time/tolerance=1e-6",
                 "Surface/elements per side=" + std::to_string(n)});
  run.to(3);
  const double early = std::abs(run.deformation().taylor_inertia - 0.3991246);
  run.to(7.5);
  const surface::Deformation end = run.deformation();
  EXPECT_LT(std::abs(run.volume_error()), 1e-12);
  return {std::max(early, std::abs(end.taylor_inertia - 0.3978509)), end.inclination};
}

TEST(ShearCapsule, ConvergesWithFourthOrderOnCoarseMeshes) {
  const Outcome coarse = outcome(3), middle = outcome(6);
  EXPECT_LT(coarse.error, 3e-3);
  EXPECT_LT(middle.error, 1e-4);
  EXPECT_GE(std::log2(coarse.error / middle.error), 4);
  EXPECT_NEAR(middle.inclination, 25.18, 0.03);  // the error of the mesh is 0.02
}

TEST(ShearCapsuleLong, ConvergesWithFourthOrderToFiveDigits) {
  const Outcome coarse = outcome(3), middle = outcome(6), fine = outcome(12);
  EXPECT_LT(fine.error, 1e-5);
  EXPECT_GE(std::log2(coarse.error / middle.error), 4);
  EXPECT_GE(std::log2(middle.error / fine.error), 4);  // the slope of a line fitted to all three errors is at least 4, too
  EXPECT_NEAR(fine.inclination, 25.18, 0.02);
}

}  // namespace
}  // namespace tanktread
