// Capsules whose membrane law is given by its strain energy move like capsules with the same built-in law.

#include <gtest/gtest.h>

#include "tests/evolution.hpp"

namespace tanktread {
namespace {

Net after_three_steps(std::vector<std::string> law) {
  law.insert(law.end(), {"Flow/type=simple shear", "Surface/elements per side=3", "Time/scheme=tr-bdf2", "Time/fixed step=0.1"});
  Evolution run(law);
  for (int k = 0; k < 3; ++k) run.step(1);
  return run.x();
}

TEST(Expression, GivesTheMotionOfTheBuiltInLaw) {
  const Net rubber = after_three_steps({"Membrane/law=neo-Hookean"});
  EXPECT_LT((after_three_steps({"Membrane/law=expression", "Membrane/energy=(I1 - 1 + 1/(I2 + 1))/2"}) - rubber).cwiseAbs().maxCoeff(), 1e-13);
  const Net skalak = after_three_steps({"Membrane/law=Skalak", "Membrane/area dilatation=2"});
  const std::vector<std::string> same = {"Membrane/law=expression", "Membrane/constants/C/value=2",
                                         "Membrane/energy=(I1^2 + 2*I1 - 2*I2 + C*I2^2)/4"};
  EXPECT_LT((after_three_steps(same) - skalak).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_GT((skalak - rubber).cwiseAbs().maxCoeff(), 1e-4);  // the two laws give different results
}

}  // namespace
}  // namespace tanktread
