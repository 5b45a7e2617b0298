#include "base/register.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace tanktread {
namespace {

TEST(Register, InverseRootsAreAccurateAtEverySize) {
  for (double a = 1e-290; a < 1e290; a *= 1.37) {
    Register values;
    for (int l = 0; l < lanes; ++l) values[l] = a * (1 + 0.11 * l);
    const Register found = inverse_root(values);
    for (int l = 0; l < lanes; ++l) EXPECT_NEAR(found[l] * std::sqrt(values[l]), 1, 1e-15) << values[l];
  }
}

TEST(Register, InverseRootsOfZeroAreZero) {
  Register values{};
  values[0] = 4;
  const Register found = inverse_root(values);
  EXPECT_NEAR(found[0], 0.5, 1e-15);
  for (int l = 1; l < lanes; ++l) EXPECT_EQ(found[l], 0);
  FloatRegister singles{};
  singles[0] = 4;
  EXPECT_NEAR(inverse_root(singles)[0], 0.5f, 1e-7f);
  EXPECT_EQ(inverse_root(singles)[1], 0);
}

TEST(Register, ALaneDoesNotDependOnItsNeighbours) {
  Register alone{}, together;
  for (int l = 0; l < lanes; ++l) together[l] = 0.3 + l;
  alone[lanes - 1] = together[lanes - 1];
  EXPECT_EQ(inverse_root(alone)[lanes - 1], inverse_root(together)[lanes - 1]);
}

TEST(Pack, ContainsConsecutiveRegisters) {
  Pack packs[3] = {};
  EXPECT_EQ(most_lanes % pack_lanes(), 0);
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < pack_lanes(); ++l) numbers(packs)[pack_lanes() * k + l] = pack_lanes() * k + l;
  for (int i = 0; i < most_lanes; ++i) EXPECT_EQ(reinterpret_cast<const double*>(packs)[i], i < 3 * pack_lanes() ? i : 0);
}

TEST(Register, SumsItsLanes) {
  Register values;
  double expected = 0;
  for (int l = 0; l < lanes; ++l) expected += values[l] = 1 << l;
  EXPECT_EQ(sum(values), expected);
}

}  // namespace
}  // namespace tanktread
