// Pressure on a spheroid with plain poles, whose elements at the poles are degenerate. With a fixed Gauss rule it does not converge, as in Figure
// 9(a) of the paper. It converges with adaptive rules, and with fixed rules if the elements are transformed as in the paper.

#include <gtest/gtest.h>

#include "tests/rigid.hpp"

namespace tanktread {
namespace {

/// Returns the L2 error of the pressure, with `meridional` elements along a meridian.
double pressure_error(const std::string& poles, const std::string& rule, int meridional) {
  return rigid_solution("spheroid_polar.yaml",
                        {"Surface/poles=" + poles, "Quadrature/rule=" + rule, "Particle/forces=integral",
                         "Surface/meridional elements=" + std::to_string(meridional),
                         "Surface/azimuthal elements=" + std::to_string(2 * meridional)})
      .surface.pressure;
}

TEST(PlainPoles, StagnateUnderAFixedRule) {
  const double coarse = pressure_error("plain", "fixed", 4), middle = pressure_error("plain", "fixed", 8),
               fine = pressure_error("plain", "fixed", 16);
  EXPECT_GT(middle, coarse / 3);  // at the order of the space it would be smaller by a factor of 8
  EXPECT_GT(fine, coarse / 3);    // at the order of the space it would be smaller by a factor of 64
  EXPECT_GT(fine, 1e-3);
}

TEST(PlainPoles, ConvergeUnderARuleByTolerance) {
  const double coarse = pressure_error("plain", "adaptive", 4), middle = pressure_error("plain", "adaptive", 8),
               fine = pressure_error("plain", "adaptive", 16);
  EXPECT_LT(middle, coarse / 7);
  EXPECT_LT(fine, middle / 7);
}

TEST(PlainPoles, ConvergeOnceTransformed) {
  const double coarse = pressure_error("bezier transform", "fixed", 4), middle = pressure_error("bezier transform", "fixed", 8);
  EXPECT_LT(middle, coarse / 5);
}

}  // namespace
}  // namespace tanktread
