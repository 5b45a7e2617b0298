#include "membrane/laws.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "capsules.hpp"

namespace tanktread::membrane {
namespace {

const Law neo_hookean = NeoHookean{1.3}, skalak = Skalak{1.3, 2.5}, mooney = MooneyRivlin{1.3, 0.4}, evans = EvansSkalak{1.3, 2.5},
          interface = SurfaceTension{1.3}, spring = MaxwellSpring{1.3, 2.5};
static_assert(std::variant_size_v<Law> == 8, "add the new law to the lists of the tests");  // AreaElasticity and UserLaw have tests of their own

TEST(Laws, AnUnstretchedMembraneHasNoEnergyAndNoTension) {
  for (const Law& law : {neo_hookean, skalak, mooney, evans}) {
    EXPECT_EQ(energy(law, 1, 1), 0);
    EXPECT_EQ(principal_tensions(law, 1, 1)[0], 0);
    EXPECT_EQ(principal_tensions(law, 1, 1)[1], 0);
  }
}

TEST(Laws, DerivativesAreThoseOfTheEnergy) {
  for (const Law& law : {neo_hookean, skalak, mooney, evans, interface, spring})
    EXPECT_LT(std::visit([](const auto& l) { return response_error(l, 0.7, 0.4); }, law), 1e-9);
}

TEST(Laws, TensionIsTheWorkOfStretchingAcrossTheOtherStretch) {
  const double l1 = 1.4, l2 = 0.8, h = 1e-5;  // differences as in response_error
  for (const Law& law : {neo_hookean, skalak, mooney, evans, interface}) {
    const auto t = principal_tensions(law, l1, l2);
    EXPECT_NEAR(t[0], (energy(law, l1 + h, l2) - energy(law, l1 - h, l2)) / (2 * h) / l2, 1e-9);
    EXPECT_NEAR(t[1], (energy(law, l1, l2 + h) - energy(law, l1, l2 - h)) / (2 * h) / l1, 1e-9);
  }
}

/// T1 = G_s/(l1 l2) (l1^2 - 1/(l1 l2)^2) and T1 = G_s l1/l2 (l1^2 - 1 + C l2^2 (l1^2 l2^2 - 1)); Barthes-Biesel, Diaz, Dhenin 2002, eqs 2.17, 2.20.
TEST(Laws, PrincipalTensionsAreTheTextbookOnes) {
  const double l1 = 1.3, l2 = 0.9, js = l1 * l2;
  EXPECT_NEAR(principal_tensions(neo_hookean, l1, l2)[0], 1.3 / js * (l1 * l1 - 1 / (js * js)), 1e-14);  // round-off
  EXPECT_NEAR(principal_tensions(skalak, l1, l2)[0], 1.3 * l1 / l2 * (l1 * l1 - 1 + 2.5 * l2 * l2 * (js * js - 1)), 1e-14);
}

/// T1 = G_s (m + (1 - m) l2^2) (l1^2 - 1/(l1 l2)^2)/(l1 l2) (Barthes-Biesel, Diaz & Dhenin 2002) and T1 = G_s (l1^2 - l2^2)/(2 (l1 l2)^2) + K_s (l1
/// l2 - 1) (Evans & Skalak 1980).
TEST(Laws, RubberThatHardensAndShearApartFromDilatationAreTheTextbookOnes) {
  const double l1 = 1.3, l2 = 0.9, js = l1 * l2;
  EXPECT_NEAR(principal_tensions(mooney, l1, l2)[0], 1.3 * (0.4 + 0.6 * l2 * l2) * (l1 * l1 - 1 / (js * js)) / js, 1e-14);  // round-off
  EXPECT_NEAR(principal_tensions(evans, l1, l2)[0], 1.3 * (l1 * l1 - l2 * l2) / (2 * js * js) + 1.3 * 6 * (js - 1), 1e-14);
}

TEST(Laws, AreaModulusIsTheTensionOfASmallChangeOfArea) {
  const double pull = 1e-6;
  for (const Law& law : {neo_hookean, skalak, mooney, evans, interface})
    EXPECT_NEAR((principal_tensions(law, 1 + pull, 1 + pull)[0] - principal_tensions(law, 1, 1)[0]) / (2 * pull), area_modulus(law), 1e-4);
}

TEST(Laws, AFluidInterfaceHasAUniformTension) {
  EXPECT_NEAR(principal_tensions(interface, 1.7, 0.4)[0], 1.3, 1e-15);  // round-off
  EXPECT_NEAR(principal_tensions(interface, 1.7, 0.4)[1], 1.3, 1e-15);
}

TEST(Laws, NeoHookeanAndSkalakOfUnitCAgreeForSmallStretch) {
  const auto difference = [](double size) {
    const auto a = principal_tensions(NeoHookean{1}, 1 + size, 1 - 0.3 * size),
               b = principal_tensions(Skalak{1, 1}, 1 + size, 1 - 0.3 * size);
    return std::hypot(a[0] - b[0], a[1] - b[1]);
  };
  EXPECT_LT(difference(1e-3), 1e-4 * 1e-3 * 1e3);            // second order in the stretch
  EXPECT_NEAR(difference(2e-3) / difference(1e-3), 4, 0.1);  // 4 (1 + O(1e-3))
}

/// The surface Poisson ratio is C/(1 + C): a strip pulled along 1 and free along 2.
TEST(Laws, SkalakHasTheSurfacePoissonRatioOfItsC) {
  for (double c : {0., 1., 10.}) {
    const double pull = 1e-6, thin = -pull * c / (1 + c);
    const auto t = principal_tensions(Skalak{1, c}, 1 + pull, 1 + thin);
    EXPECT_LT(std::abs(t[1]), 1e-4 * t[0]);  // the error of linear elasticity is about C times the strain `pull`
  }
}

}  // namespace
}  // namespace tanktread::membrane
