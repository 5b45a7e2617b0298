// Tolerances that are not met, or that cost more than they are worth. See the maps `step-tolerance`, `quadrature-tolerance` and
// `volume-drift` of tests/benchmark/atlas.py.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/evolution.hpp"

namespace tanktread {
namespace {

struct Outcome {
  double deformation, volume_error;
  long evaluations;
};

Outcome outcome(std::vector<std::string> settings, double end) {
  settings.push_back("Surface/elements per side=3");
  Evolution run(settings);
  run.to(end);
  return {run.deformation().taylor_inertia, std::abs(run.volume_error()), run.capsule->counts().evaluations};
}

Outcome stiff(const std::string& scheme, const std::string& tolerance, const std::string& constraint = "flux") {
  return outcome({"Membrane/capillary number=0.05", "Membrane/pre-inflation=0.05", "Volume/constraint=" + constraint,
                  "Time/scheme=" + scheme, "Time/tolerance=" + tolerance},
                 2);
}

TEST(Tolerances, OfAnExplicitSchemeAtItsStabilityLimitSaveNothingWhenLarge) {
  const Outcome loose = stiff("bs3", "1e-2"), tight = stiff("bs3", "1e-5");
  EXPECT_NEAR(static_cast<double>(loose.evaluations) / tight.evaluations, 1, 0.1);
  EXPECT_GT(loose.volume_error, 100 * tight.volume_error);  // noise of the stiff modes makes the volume drift
  EXPECT_LT(stiff("tr-bdf2", "1e-2").evaluations, loose.evaluations / 4);
}

TEST(Tolerances, OfAStepDoNotAffectTheVolumeWithTheExactConstraint) {
  for (const char* scheme : {"bs3", "tr-bdf2"}) EXPECT_LT(stiff(scheme, "1e-2", "exact").volume_error, 1e-12) << scheme;
}

Outcome unconstrained(const std::vector<std::string>& quadrature) {
  // time steps so accurate that they lose no volume
  std::vector<std::string> settings{"Volume/constraint=none", "Membrane/load measure=current", "Time/tolerance=1e-6"};
  settings.insert(settings.end(), quadrature.begin(), quadrature.end());
  return outcome(settings, 2);
}

TEST(Tolerances, OfIntegralsAffectTheVolumeOnlyBelowThreePointsPerElement) {
  const Outcome tight = unconstrained({"Quadrature/tolerance=1e-8"});
  EXPECT_GT(unconstrained({"Quadrature/rule=fixed", "Quadrature/points=2"}).volume_error, 2 * tight.volume_error);
  const Outcome loose = unconstrained({"Quadrature/rule=fixed", "Quadrature/points=3"});
  EXPECT_LT(loose.volume_error, 1.5 * tight.volume_error);
  EXPECT_NEAR(loose.deformation, tight.deformation, 1e-4);
}

TEST(Tolerances, VolumeErrorsGrowInALongRunWithoutTheConstraint) {
  const std::vector<std::string> scene{"Volume/constraint=none", "Membrane/load measure=current", "Membrane/capillary number=0.6"};
  EXPECT_GT(outcome(scene, 6).volume_error, 2 * outcome(scene, 2).volume_error);
}

}  // namespace
}  // namespace tanktread
