// Tests of the rule (1.4) on artificial metrics.

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
  const auto found = marks(std::vector<surface::ElementMetrics>{m}, options());
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

TEST(Adaptation, SlenderElementsAreDividedUnlessTheyHaveTheMinimumLength) {
  EXPECT_TRUE(cut(element(0.26, 0.1), 0));
  EXPECT_FALSE(cut(element(0.24, 0.1), 0));
  EXPECT_FALSE(cut(element(0.049, 0.01), 0));
}

TEST(Adaptation, MergedElementsAreNotDividedAgain) {
  for (const double a : {0.03, 0.06, 0.1, 0.15, 0.3})
    for (const double b : {0.03, 0.06, 0.1, 0.15, 0.3})
      for (const double traction : {0.0, 9.0, 20.0})
        for (const spline::Merge& merge : merges(std::vector<surface::ElementMetrics>{element(a, b, traction)}, options())) {
          const auto twice = element(merge.s ? 2 * a : a, merge.t ? 2 * b : b, traction);
          for (const spline::Mark& mark : marks(std::vector<surface::ElementMetrics>{twice}, options()))
            EXPECT_FALSE((merge.s && mark.s) || (merge.t && mark.t)) << a << " " << b << " " << traction;
        }
}

using Resolved = std::array<surface::Resolution, 2>;

/// Returns the resolution along one direction: length, errors, and the error of an element of twice the length.
surface::Resolution along(double length, double surface, double load = 0, double merged = 0) { return {length, {surface, load}, {merged, 0}}; }

TEST(Adaptation, AnErrorAboveItsToleranceDividesElementsInItsDirection) {
  AdaptationOptions o;
  o.surface_tolerance = 1e-3;
  o.minimum_length = 0.05;
  const std::vector<Resolved> elements = {
      {along(0.2, 1.1e-3), along(0.2, 0.9e-3)}, {along(0.04, 1), along(0.04, 1)}, {along(0.2, 0, 0.5), along(0.2, 0)}};
  const auto found = marks(elements, o);
  ASSERT_EQ(found.size(), 1u);  // the second element has the minimum length; the load of the third is not checked
  EXPECT_EQ(found[0].element, 0);
  EXPECT_TRUE(found[0].s);
  EXPECT_FALSE(found[0].t);
  o.load_tolerance = 0.4;
  EXPECT_EQ(marks(std::vector<Resolved>{{along(0.2, 0, 0.5), along(0.2, 0)}}, o).size(), 1u);
}

TEST(Adaptation, TheErrorOfFieldsIsComparedWithTheSurfaceToleranceOverTheRadius) {
  AdaptationOptions o;
  o.radius = 5;
  o.surface_tolerance = 1e-3;
  const auto with = [](double error) { return std::vector<Resolved>{{surface::Resolution{1, {0, 0, error}, {0, 0, error}}, along(1, 0)}}; };
  EXPECT_EQ(marks(with(1.9e-4), o).size(), 0u);
  ASSERT_EQ(marks(with(2.1e-4), o).size(), 1u);
  EXPECT_FALSE(marks(with(2.1e-4), o)[0].t);
  EXPECT_TRUE(merges(with(1.3e-4), o)[0].s);   // below `coarsening margin` (0.7) times the tolerance 1e-3/5
  EXPECT_FALSE(merges(with(1.5e-4), o)[0].s);
}

TEST(Adaptation, ElementsMergedByTheirErrorAreNotDividedAgain) {
  AdaptationOptions o;
  o.surface_tolerance = 1e-3;
  int merged = 0;
  for (const double error : {1e-5, 5e-4, 8e-4, 2e-3})
    for (const spline::Merge& merge : merges(std::vector<Resolved>{{along(0.2, error / 16, 0, error), along(0.2, 1e-9)}}, o)) {
      merged += merge.s;
      const std::vector<Resolved> then = {{along(0.4, error), along(0.4, 16e-9)}};
      for (const spline::Mark& mark : marks(then, o)) EXPECT_FALSE(merge.s && mark.s) << error;
    }
  EXPECT_EQ(merged, 2);  // the errors 1e-5 and 5e-4: only they are below `coarsening margin` (0.7) times the tolerance 1e-3
}

TEST(Adaptation, CoarserLimitsMarkTheWorstElementsOnly) {
  AdaptationOptions o;
  o.surface_tolerance = 1e-3;
  const std::vector<Resolved> elements = {{along(0.2, 1.5e-3), along(0.2, 0)}, {along(0.2, 3e-3), along(0.2, 0)}};
  EXPECT_EQ(marks(elements, o).size(), 2u);
  ASSERT_EQ(marks(elements, o.coarser(2)).size(), 1u);
  EXPECT_EQ(marks(elements, o.coarser(2))[0].element, 1);
  EXPECT_EQ(marks(elements, o.coarser(4)).size(), 0u);
  const std::vector<surface::ElementMetrics> long_and_slender = {element(0.5, 0.3), element(0.9, 0.3), element(0.3, 0.11)};
  EXPECT_EQ(marks(long_and_slender, options()).size(), 3u);
  EXPECT_EQ(marks(long_and_slender, options().coarser(2)).size(), 1u);
}

}  // namespace
}  // namespace tanktread::motion
