// Gaps. If the faces of a thin rigid disc are closer to each other than the points of a fixed quadrature rule, its integrals are wrong. Rules by
// tolerance are not affected by the gap. See the map `gap` of tests/benchmark/atlas.py.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/rigid.hpp"

namespace tanktread {
namespace {

/// Returns the relative error of the drag on a disc of radius 1 due to quadrature, compared with a tight tolerance on the same mesh.
double integral_error(double half_thickness, const std::vector<std::string>& rule) {
  const std::vector<std::string> disc{"Surface/elements per side=4", "Particle/forces=integral",
                                      "Particle/semi-axes=[1.0, 1.0, " + std::to_string(half_thickness) + "]"};
  const auto drag = [&](std::vector<std::string> settings) {
    settings.insert(settings.end(), disc.begin(), disc.end());
    return rigid_solution("spheroid_cube.yaml", settings).force[0];
  };
  return std::abs(drag(rule) / drag({"Quadrature/tolerance=1e-10"}) - 1);
}

TEST(Gap, IsNotResolvedByAFixedRuleWithASpacingLargerThanTheGap) {
  const std::vector<std::string> fixed{"Quadrature/rule=fixed", "Quadrature/points=4"};
  EXPECT_LT(integral_error(0.5, fixed), 1e-3);
  EXPECT_GT(integral_error(0.1, fixed), 5 * integral_error(0.5, fixed));  // measured: 2e-4 and 6e-6
}

TEST(Gap, IsResolvedByRulesWithATolerance) {
  // the solution of the equation amplifies the quadrature error
  for (const double h : {0.5, 0.1}) EXPECT_LT(integral_error(h, {"Quadrature/tolerance=1e-7"}), 1e-5) << h;
}

}  // namespace
}  // namespace tanktread
