// Two hundred random refinement sequences, six levels deep: the spaces stay nested and independent. The long form does the same on more meshes
// and with more marks.

#include <gtest/gtest.h>

#include "tests/unit/spline/sequences.hpp"

namespace tanktread::spline {
namespace {

void expect_nested(const Findings& found) {
  EXPECT_EQ(found.crossings, 0);
  EXPECT_EQ(found.overlaps, 0);
  EXPECT_EQ(found.broken_zones, 0);
  EXPECT_EQ(found.straddling, 0);
  EXPECT_EQ(found.wrong_counts, 0);
  EXPECT_LT(found.unity, 1e-13);
  EXPECT_LT(found.residual, 1e-12);  // of fields of size 1; about 1e-14 measured
  EXPECT_LT(found.condition, 15);
  EXPECT_GT(found.least_diagonal, 0.25);
}

TEST(Refinement, TwoHundredSequencesSixLevelsDeepStayNested) {
  Findings found;
  SequenceOptions options;
  options.steps = 6;
  options.fraction = 0.01;
  const TMesh base[2] = {cube(3, 6), cube(4, 6)};
  for (unsigned seed = 0; seed < 200; ++seed) {
    options.condition = seed % 4 == 0;
    run_sequence(base[seed % 2], seed, options, found);
  }
  expect_nested(found);
  EXPECT_EQ(found.steps, 1200);
  EXPECT_EQ(found.finest, 1);  // all six levels were reached
}

TEST(RefinementLong, AThousandSequencesStayNested) {
  Findings found;
  SequenceOptions options;
  options.condition = true;
  const int n[5] = {3, 4, 5, 6, 8}, levels[5] = {6, 5, 4, 4, 4};
  std::vector<TMesh> base;
  for (int i = 0; i < 5; ++i) base.push_back(cube(n[i], levels[i]));
  const double fraction[4] = {0.005, 0.02, 0.05, 0.15};
  for (unsigned seed = 0; seed < 1000; ++seed) {
    options.steps = levels[seed % 5];
    options.fraction = fraction[seed / 5 % 4];
    if (options.fraction > 0.1) options.steps = std::min(options.steps, 3);
    options.deep = int(seed % 3);
    run_sequence(base[seed % 5], 1000 + seed, options, found);
  }
  expect_nested(found);
}

}  // namespace
}  // namespace tanktread::spline
