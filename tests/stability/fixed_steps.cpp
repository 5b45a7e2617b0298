// Largest fixed time steps. Explicit steps and the sub-iteration of Crank-Nicolson are limited by the fastest mode of the mesh (4.5); the
// quasi-Newton iteration of TR-BDF2 is not. See the maps `fixed-step`, `fixed-step-dilatation` and `fixed-step-mesh` of
// tests/benchmark/atlas.py.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "tests/evolution.hpp"

namespace tanktread {
namespace {

using Settings = std::vector<std::string>;

Settings with(Settings settings, const std::string& scheme, double step) {
  settings.push_back("Time/scheme=" + scheme);
  settings.push_back("Time/fixed step=" + std::to_string(step));
  return settings;
}

/// Returns true if the run reaches `end` with the energy of a run with error control, within 5 %.
bool follows(const Settings& settings, const std::string& scheme, double step, double end) {
  Evolution reference(settings), run(with(settings, scheme, step));
  reference.to(end);
  try {
    while (run.state.time < end && run.energy() < 2 * reference.energy()) run.step(end);  // an unstable run becomes expensive
  } catch (const RunFailure&) {
    return false;
  }
  return std::abs(run.energy() / reference.energy() - 1) < 0.05;  // false for NaN
}

Settings capsule(double ca, int n, double dilatation = 1) {
  Settings settings{"Surface/elements per side=" + std::to_string(n), "Membrane/capillary number=" + std::to_string(ca)};
  if (dilatation != 1) settings.insert(settings.end(), {"Membrane/law=Skalak", "Membrane/area dilatation=" + std::to_string(dilatation)});
  return settings;
}

/// Returns 2.51/rho by (4.5), for elements of size pi/(2 n).
double explicit_limit(double ca, int n, double dilatation = 1) { return 2.51 * ca / ((1 + dilatation) * n); }

TEST(FixedStep, OfAnExplicitSchemeIsLimitedByTheStiffnessForAnyCaAndC) {
  for (const double ca : {0.05, 0.2}) {
    const double limit = explicit_limit(ca, 3);
    EXPECT_TRUE(follows(capsule(ca, 3), "bs3", 0.6 * limit, 30 * limit)) << ca;
    EXPECT_FALSE(follows(capsule(ca, 3), "bs3", 1.5 * limit, 30 * limit)) << ca;
  }
  const double limit = explicit_limit(0.3, 3, 30);
  EXPECT_TRUE(follows(capsule(0.3, 3, 30), "bs3", 0.6 * limit, 30 * limit));
  EXPECT_FALSE(follows(capsule(0.3, 3, 30), "bs3", 1.5 * limit, 30 * limit));
}

TEST(FixedStep, OfTheQuasiNewtonSchemeIsNot) {
  const double limit = explicit_limit(0.05, 3);
  EXPECT_TRUE(follows(capsule(0.05, 3), "tr-bdf2", 6 * limit, 30 * limit));
}

TEST(FixedStep, OfSubIteratedCrankNicolsonIsShorterThanTheExplicitOne) {
  const double limit = explicit_limit(0.1, 3);
  EXPECT_TRUE(follows(capsule(0.1, 3), "crank-nicolson", 0.15 * limit, 3 * limit));
  EXPECT_FALSE(follows(capsule(0.1, 3), "crank-nicolson", limit, 30 * limit));
}

/// Returns the settings of section 4.2 of the paper: structured mesh of 842 control points with its poles on x2, Ca = 0.45, the paper's scheme.
Settings poles_on_x2() {
  return {"Surface/mesh=polar",           "Surface/pole axis=x2", "Surface/azimuthal elements=40", "Surface/meridional elements=20",
          "Quadrature/rule=fixed",        "Quadrature/points=8",  "Volume/constraint=flux",        "Membrane/capillary number=0.45",
          "Membrane/load measure=current"};
}

TEST(FixedStepLong, OfAHundredthOfCaDoesNotConvergeWithPolesOutOfTheShearPlane) {
  Evolution run(with(poles_on_x2(), "crank-nicolson", 0.0045));
  EXPECT_THROW(run.to(0.4), RunFailure);  // measured: at the time 0.16
}

TEST(FixedStepLong, ReducedByAQuarterOrChosenByTheSchemeConvergesThere) {
  Evolution reduced(with(poles_on_x2(), "crank-nicolson", 0.75 * 0.0045));
  EXPECT_NO_THROW(reduced.to(0.25));
  Settings adaptive = poles_on_x2();
  adaptive.insert(adaptive.end(), {"Time/scheme=crank-nicolson", "Time/initial step=0.0045"});
  Evolution chosen(adaptive);
  EXPECT_NO_THROW(chosen.to(0.25));
}

}  // namespace
}  // namespace tanktread
