// Strong form on the structured mesh, Ca = 0.45 (section 4.2 of the paper, Figure 12): the step size goes to zero, earliest with the poles on x2. The
// weak form completes the run. Map load-form of tests/benchmark/atlas.py.

#include <string>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "tests/evolution.hpp"

namespace tanktread {
namespace {

/// Returns the time that the run reached; its final time is 2.
double reached(const std::string& load, const std::string& axis) {
  Evolution run({"Surface/mesh=polar", "Surface/pole axis=" + axis, "Surface/azimuthal elements=16", "Surface/meridional elements=8",
                 "Membrane/capillary number=0.45", "Membrane/load=" + load, "Time/minimum step=1e-4"});
  try {
    run.to(2);
  } catch (const RunFailure&) {
  }
  return run.state.time;
}

TEST(PoleAxes, StopRunsWithTheStrongForm) {
  for (const char* axis : {"x1", "x2"}) EXPECT_LT(reached("strong", axis), 2) << axis;  // measured: 1.8 and 1.5; with the poles on x3 it is later
}

TEST(PoleAxes, HaveNoInfluenceOnTheWeakForm) {
  for (const char* axis : {"x1", "x2", "x3"}) EXPECT_EQ(reached("weak", axis), 2) << axis;
}

}  // namespace
}  // namespace tanktread
