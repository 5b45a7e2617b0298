// Viscosity ratios towards 0 and 100. The system for the velocity nearly loses its breathing mode as lambda -> 0: without the flux constraint
// volume goes with it. Map viscosity-ratio of tests/benchmark/atlas.py.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/evolution.hpp"

namespace tanktread {
namespace viscosity_ratio_test {

struct Outcome {
  double volume_error, iterations;
};

/// At time 0.5; iterations of the velocity's system, each.
Outcome outcome(const std::string& ratio, const std::string& constraint) {
  Evolution run({"Surface/elements per side=3", "Particle/viscosity ratio=" + ratio, "Volume/constraint=" + constraint,
                 "Membrane/load measure=current"});
  run.to(0.5);
  const coupling::Work& work = run.capsule->work();
  return {std::abs(run.capsule->volume_error(run.state.x)),
          static_cast<double>(work.velocity_iterations) / static_cast<double>(work.evaluations)};
}

TEST(ViscosityRatio, TowardsZeroLosesVolumeWithoutTheFluxConstraint) {
  EXPECT_GT(outcome("0.001", "none").volume_error, 0.01);  // 0.07 measured
  EXPECT_LT(outcome("0.001", "exact").volume_error, 1e-7);
}

TEST(ViscosityRatio, NeedsNoMoreIterationsAtEitherEndWithIt) {
  for (const char* ratio : {"0.001", "0.1", "10", "100"}) EXPECT_LT(outcome(ratio, "exact").iterations, 12) << ratio;  // 7 to 9 measured
}

}  // namespace viscosity_ratio_test
}  // namespace tanktread
