// The rule P-37 on made-up metrics.

#include <gtest/gtest.h>

#include "motion/adaptation.hpp"

namespace tanktread::motion {
namespace {

surface::ElementMetrics element(double length_s, double length_t, double traction_s = 0) {
  surface::ElementMetrics m;
  m.along[0] = {length_s, traction_s, 0, 0};
  m.along[1] = {length_t, 0, 0, 0};
  return m;
}

AdaptationOptions options() {
  AdaptationOptions o;
  o.reference_length = 0.4;
  o.reference_traction_variation = 8;
  o.limit_aspect_ratio = 2.5;
  o.order = 2;
  o.minimum_length = 0.05;
  return o;
}

bool cut(const surface::ElementMetrics& m, int direction) {
  const auto found = marks({m}, options());
  return !found.empty() && (direction == 0 ? found[0].s : found[0].t);
}

TEST(Adaptation, LongElementsAreCutAlongTheirLength) {
  EXPECT_TRUE(cut(element(0.41, 0.3), 0));
  EXPECT_FALSE(cut(element(0.41, 0.3), 1));
  EXPECT_FALSE(cut(element(0.39, 0.3), 0));
}

TEST(Adaptation, AVariationAboveItsReferenceShortensElementsByThePowerOfTheOrder) {
  EXPECT_FALSE(cut(element(0.2, 0.2, 8 * 1.4), 0));  // 0.4 / 1.96 = 0.204
  EXPECT_TRUE(cut(element(0.2, 0.2, 8 * 1.42), 0));  // 0.4 / 2.02 = 0.198
}

TEST(Adaptation, SlenderElementsAreCutUnlessTheyAreAtTheFloor) {
  EXPECT_TRUE(cut(element(0.26, 0.1), 0));
  EXPECT_FALSE(cut(element(0.24, 0.1), 0));
  EXPECT_FALSE(cut(element(0.049, 0.01), 0));
}

TEST(Adaptation, WhatIsMergedIsNotCutAgain) {
  for (const double a : {0.03, 0.06, 0.1, 0.15, 0.3})
    for (const double b : {0.03, 0.06, 0.1, 0.15, 0.3})
      for (const double traction : {0.0, 9.0, 20.0})
        for (const spline::Merge& merge : merges({element(a, b, traction)}, options())) {
          const auto twice = element(merge.s ? 2 * a : a, merge.t ? 2 * b : b, traction);
          for (const spline::Mark& mark : marks({twice}, options()))
            EXPECT_FALSE((merge.s && mark.s) || (merge.t && mark.t)) << a << " " << b << " " << traction;
        }
}

}  // namespace
}  // namespace tanktread::motion
