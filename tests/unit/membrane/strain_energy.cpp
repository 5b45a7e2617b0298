#include "membrane/strain_energy.hpp"

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "capsules.hpp"
#include "membrane/laws.hpp"

namespace tanktread::membrane {
namespace strain_energy_test {

using Constants = std::map<std::string, double>;

UserLaw own(const std::string& text, const Constants& constants = {}, double unit = 1.3) {
  return {unit, std::make_shared<const StrainEnergy>("Membrane/energy", text, constants)};
}

const std::string neo_hookean = "(I1 - 1 + 1/(I2 + 1))/2", skalak = "(I1^2 + 2*I1 - 2*I2 + C*I2^2)/4",
                  evans = "((I1 + 2)/J - 2)/2 + K/2*(J - 1)^2", fung = "(exp(k*(I1 - 1 + 1/(I2 + 1))) - 1)/(2*k)",
                  odd = "((I1 + 2)/2)^1.3 - 0.65*log(I2 + 1) + J^-1.3 + 0.65*I2 + (sqrt(J) - 1)^3";

/// Returns the error message for a text that is not an energy.
std::string refusal(const std::string& text, const Constants& constants = {}) {
  try {
    own(text, constants);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(StrainEnergy, OfABuiltInLawIsThatLaw) {
  const std::vector<std::pair<UserLaw, Law>> pairs = {{own(neo_hookean), NeoHookean{1.3}},
                                                     {own(skalak, {{"C", 2.5}}), Skalak{1.3, 2.5}},
                                                     {own(evans, {{"K", 6}}), EvansSkalak{1.3, 2.5}}};
  for (const auto& [expression, law] : pairs)
    for (const double i1 : {-0.3, 0.0, 0.7})
      for (const double i2 : {-0.2, 0.0, 1.4})
        std::visit(
            [&](const auto& l) {
              const auto a = expression.response(i1, i2), b = l.response(i1, i2);
              EXPECT_NEAR(expression.energy(i1, i2), l.energy(i1, i2), 1e-14);  // round-off of values of order 10, here and below
              EXPECT_NEAR(a.psi1, b.psi1, 1e-14);
              EXPECT_NEAR(a.psi2, b.psi2, 1e-14);
              EXPECT_NEAR(a.psi11, b.psi11, 1e-14);
              EXPECT_NEAR(a.psi12, b.psi12, 1e-14);
              EXPECT_NEAR(a.psi22, b.psi22, 5e-14);
            },
            law);
}

TEST(StrainEnergy, DerivativesAreThoseOfTheText) {
  for (const UserLaw& law : {own(fung, {{"k", 0.7}}), own(odd)}) EXPECT_LT(response_error(law, 0.7, 0.4), 2e-9);
}

TEST(StrainEnergy, ModuliAreThoseOfSmallStrains) {
  for (const UserLaw& law : {own(neo_hookean), own(skalak, {{"C", 2.5}}), own(fung, {{"k", 0.7}})}) {
    const double e = 1e-5;
    EXPECT_NEAR(energy(law, 1 + e, 1 - e) / (2 * e * e), 1.3 * law.strain_energy->shear_modulus(), 1e-4);  // round-off over e^2
    EXPECT_NEAR(principal_tensions(law, 1 + e, 1 + e)[0] / (2 * e), law.area_modulus(), 5e-4);             // truncation error of order e
    EXPECT_NEAR(principal_tensions(law, 1, 1)[0], 0, 1e-15);
    EXPECT_EQ(energy(law, 1, 1), 0);
  }
}

/// Evaluations with registers and with dual numbers give the same results as with single numbers.
TEST(StrainEnergy, LoadAndTangentAreTheDifferencesOfTheEnergy) {
  const Sphere& s = sphere(3);
  const Net x = deformed(s.net), u = random_net(x.rows(), 1);
  for (const UserLaw& law : {own(skalak, {{"C", 2.5}}), own(fung, {{"k", 0.7}}), own(odd)}) {
    const Membrane membrane(s.space, s.net, Law(law));
    EXPECT_LT(gradient_error(membrane, x, u), 1e-8);
    EXPECT_LT(tangent_error(membrane, s, x, u), 1e-8);
  }
}

/// Compares the strong form of the load (equation 3 of Maestre et al. 2017), which uses dual numbers, with the load of a built-in law.
TEST(StrainEnergy, TheStrongLoadIsThatOfTheBuiltInLaw) {
  const Sphere& s = sphere(3);
  const Net x = deformed(s.net);
  const Membrane expression(s.space, s.net, Law(own(evans, {{"K", 6}}))), law(s.space, s.net, EvansSkalak{1.3, 2.5});
  const spline::Site site{3, 0.3, 0.6};
  EXPECT_LT((expression.strong_load(x, site) - law.strong_load(x, site)).norm(), 1e-12 * law.strong_load(x, site).norm());
}

TEST(StrainEnergy, AWrongEnergyIsRejectedWithItsValues) {
  const auto says = [](const std::string& sentence, const std::string& part) { return sentence.find(part) != std::string::npos; };
  EXPECT_PRED2(says, refusal("(I1 - 1 + 1/(I2 + 1)/2"), "`)` is expected at the end");
  EXPECT_PRED2(says, refusal("I1 + * I2"), "at character 6");
  EXPECT_PRED2(says, refusal("I1 + stiffness*I2"), "`stiffness`");
  EXPECT_PRED2(says, refusal("I1^I2"), "exponent");
  EXPECT_PRED2(says, refusal("I1/0"), "division by zero");
  EXPECT_PRED2(says, refusal("2"), "is constant");
  EXPECT_PRED2(says, refusal("I1"), "tension");
  EXPECT_PRED2(says, refusal("I1^1.5"), "not finite");
  EXPECT_PRED2(says, refusal("(I2 - I1)/2"), "shear modulus is -1");
  EXPECT_PRED2(says, refusal("(I1 - I2)/2"), "area modulus is -1");
  EXPECT_PRED2(says, refusal(neo_hookean, {{"C", 2}}), "does not use the constant `C`");
  EXPECT_PRED2(says, refusal(neo_hookean, {{"J", 2}}), "`J` has a meaning");
  std::string sum = neo_hookean;
  for (int k = 0; k < 100; ++k) sum += " + I2^2";
  EXPECT_PRED2(says, refusal(sum), "too long");
  EXPECT_PRED2(says, refusal(std::string(100000, '-') + "I1"), "100002 characters");
}

}  // namespace strain_energy_test
}  // namespace tanktread::membrane
