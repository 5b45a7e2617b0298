#include "membrane/surfactant_options.hpp"

#include <cmath>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/section.hpp"

namespace tanktread::membrane {

void SurfactantOptions::declare(deck::Section& section) {
  section.key("equation of state", equation_of_state, deck::Choice{"linear", "Langmuir"},
              "surface tension of a drop with surfactant as a function of the concentration, divided by the surface tension of the clean "
              "interface (Membrane/surface tension or capillary number). `linear`: 1 - E c. `Langmuir`: 1 + E ln(1 - x c). c: concentration "
              "divided by the initial concentration, E: `elasticity number`, x: `coverage`");
  section.key("elasticity number", elasticity, deck::positive(), "1",
              "elasticity number E of the surfactant: gas constant x temperature x concentration / surface tension of the clean interface. "
              "The concentration is the initial one for the equation of state `linear`, and the largest possible one for `Langmuir`");
  section.key("coverage", coverage, deck::between(1e-6, 0.999999), "1",
              "initial coverage x of the interface for the equation of state `Langmuir` (required for it): initial concentration of surfactant "
              "divided by the largest possible concentration");
  section.key("diffusivity", diffusivity, deck::not_negative(), "length^2/time",
              "surface diffusivity D_s of the surfactant; 0 (no diffusion) if neither `diffusivity` nor `Peclet number` is given");
  section.key("Peclet number", peclet_number, deck::positive(), "1",
              "surface Peclet number G R_C^2/D_s, which sets the surface diffusivity D_s of the surfactant instead of `diffusivity`: the "
              "larger, the less diffusion. G: Flow/shear rate, or the largest singular value of Flow/gradient. R_C: radius of the sphere "
              "with the drop's volume");
}

void SurfactantOptions::check() const {
  const std::string list = "Interface/surfactant/";
  const bool langmuir = equation_of_state == "Langmuir";
  if (coverage.has_value() != langmuir)
    throw UserError(langmuir ? list + "equation of state `Langmuir` needs " + list +
                                   "coverage, the initial concentration divided by the largest possible one."
                             : list + "coverage belongs to " + list + "equation of state `Langmuir`, not to `" + equation_of_state + "`.");
  refuse(diffusivity && peclet_number, list + "diffusivity", list + "Peclet number", "give one of them");
  if (!(tension(1) > 0))
    throw UserError(list + formatted("elasticity number %g leaves no surface tension at the initial concentration: it is %g times that of "
                                     "the clean interface. Give a smaller number.",
                                     elasticity, tension(1)));
}

double SurfactantOptions::tension(double c) const {
  return coverage ? 1 + elasticity * std::log(1 - *coverage * c) : 1 - elasticity * c;
}

double SurfactantOptions::tension_slope(double c) const { return coverage ? -elasticity * *coverage / (1 - *coverage * c) : -elasticity; }

double SurfactantOptions::free_energy(double c) const {
  if (c <= 0) return 1;
  return coverage ? tension(c) + elasticity * *coverage * c * std::log(c / (1 - *coverage * c)) : tension(c) + elasticity * c * std::log(c);
}

double SurfactantOptions::diffusivity_of(double rate, double radius) const {
  if (!peclet_number) return diffusivity.value_or(0);
  if (rate == 0) throw UserError("Interface/surfactant/Peclet number needs a flow with a gradient: give Interface/surfactant/diffusivity instead.");
  return rate * radius * radius / *peclet_number;
}

}  // namespace tanktread::membrane
