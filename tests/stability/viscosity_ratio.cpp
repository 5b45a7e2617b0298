// Viscosity ratios near 0 and up to 100. As lambda -> 0, the breathing mode nearly becomes a null vector of the system for the velocity, so volume is
// lost without the flux constraint. See the map `viscosity-ratio` of tests/benchmark/atlas.py.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/evolution.hpp"

namespace tanktread {
namespace viscosity_ratio_test {

struct Outcome {
  double volume_error, iterations;
};

/// Returns the volume error at time 0.5, and the mean number of iterations per evaluation of the velocity.
Outcome outcome(const std::string& ratio, const std::string& constraint) {
  Evolution run({"Surface/elements per side=3", "Particle/viscosity ratio=" + ratio, "Volume/constraint=" + constraint,
                 "Membrane/load measure=current"});
  run.to(0.5);
  const coupling::OperationCounts& counts = run.capsule->counts();
  return {std::abs(run.volume_error()),
          static_cast<double>(counts.velocity_iterations) / static_cast<double>(counts.evaluations)};
}

TEST(ViscosityRatio, TowardsZeroLosesVolumeWithoutTheFluxConstraint) {
  EXPECT_GT(outcome("0.001", "none").volume_error, 0.01);  // measured: 0.07
  EXPECT_LT(outcome("0.001", "exact").volume_error, 1e-7);
}

TEST(ViscosityRatio, NeedsNoMoreIterationsAtEitherEndWithIt) {
  for (const char* ratio : {"0.001", "0.1", "10", "100"}) EXPECT_LT(outcome(ratio, "exact").iterations, 12) << ratio;  // measured: 7 to 9
}

TEST(ViscosityRatio, OfAHundredNeedsNoMoreImplicitStepsThanOne) {
  const auto evaluations = [](const std::string& ratio) {
    Evolution run({"Surface/elements per side=4", "Particle/viscosity ratio=" + ratio, "Membrane/law=Skalak", "Membrane/capillary number=0.3"});
    run.to(1.5);
    return run.capsule->counts().evaluations;
  };
  // Measured: about 35. Without the factor of the relative residual (CapsuleJacobian::tolerance_factor): 252.
  EXPECT_LT(evaluations("100"), 2 * evaluations("1"));
  EXPECT_LT(evaluations("1000"), 2 * evaluations("1"));
}

}  // namespace viscosity_ratio_test
}  // namespace tanktread
