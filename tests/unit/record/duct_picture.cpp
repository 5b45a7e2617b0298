#include "record/duct_arrays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tanktread {
namespace {

TEST(DuctPicture, HoldsTheSectionAndTheVelocityInsideOfIt) {
  surface::TubeOptions tube;
  tube.section = "ellipse", tube.semi_axes = surface::Vec2(2, 1);
  const auto arrays = duct_arrays(stokes::DuctFlow(tube, 1, 0.5));
  const auto named = [&](const std::string& name) { return *std::ranges::find(arrays, name, &output::Array::name); };
  const output::Array x2 = named("x2"), x3 = named("x3"), v = named("velocity"), outline = named("outline");
  ASSERT_EQ(v.shape, (std::vector<std::size_t>{x3.values.size(), x2.values.size()}));
  for (std::size_t i = 0; i < v.values.size(); ++i) {
    const double y = x2.values[i % x2.values.size()], z = x3.values[i / x2.values.size()], u = 1 - y * y / 4 - z * z;
    if (std::abs(u) < 1e-12) continue;
    EXPECT_EQ(std::isnan(v.values[i]), u < 0);
    if (u > 0) {
      EXPECT_NEAR(v.values[i], u, 1e-13);  // on the axis the velocity is twice the mean velocity
    }
  }
  for (std::size_t i = 0; i < outline.shape[0]; ++i)
    EXPECT_NEAR(std::pow(outline.values[2 * i] / 2, 2) + std::pow(outline.values[2 * i + 1], 2), 1, 1e-13);
  EXPECT_NEAR(named("radius").values[0], std::sqrt(2), 1e-13);
  EXPECT_NEAR(named("maximum").values[2], 1, 1e-12);
}

}  // namespace
}  // namespace tanktread
