#include "membrane/options.hpp"

#include "base/errors.hpp"
#include "deck/section.hpp"
#include "membrane/strain_energy.hpp"

namespace tanktread::membrane {

namespace {

void check_stress_free(const Options& options) {
  refuse(options.law == "surface tension" && options.stress_free != "resting", "Membrane/stress-free shape", "Membrane/law `surface tension`",
         "a fluid interface has no such shape");
  const std::string shape = "Membrane/stress-free shape `", chosen = "`, not to `" + options.stress_free + "`.";
  if (options.reduced_volume.has_value() != (options.stress_free == "spheroid"))
    throw UserError(options.reduced_volume ? "Membrane/stress-free reduced volume belongs to " + shape + "spheroid" + chosen
                                           : shape + "spheroid` needs Membrane/stress-free reduced volume.");
  if (options.stress_free_file.has_value() != (options.stress_free == "file"))
    throw UserError(options.stress_free_file ? "Membrane/stress-free file belongs to " + shape + "file" + chosen
                                             : shape + "file` needs Membrane/stress-free file, the name of a Bezier-extraction text.");
}

/// Named constants of the strain energy, `Membrane/constants/<name>`.
struct Constants {
  std::map<std::string, double>& all;

  void declare(deck::Section& section) {
    section.each("a number of that name in Membrane/energy", [this](const std::string& name, deck::Section& inner) {
      if (!inner.documenting() && !inner.given("value"))
        throw UserError(inner.path("value") + " is missing: it is the number that `" + name + "` stands for.");
      inner.key("value", all[name], deck::any(), "1", "what the name stands for (required)");
    });
    if (section.documenting()) all.clear();
  }
};

void declare_energy(Options& options, deck::Section& section) {
  section.key("energy", options.energy, deck::Choice{},
              "of the law `expression`: the strain energy per unstressed area over G_s, in I1 = l1^2 + l2^2 - 2 and I2 = l1^2 l2^2 - 1 of the "
              "principal stretches l1 and l2, J = l1 l2, numbers and `constants`, by + - * / ^ exp log sqrt and parentheses. It is "
              "differentiated exactly; `(I1 - 1 + 1/(I2 + 1))/2` is the law `neo-Hookean`");
  Constants named{options.constants};
  section.optional_section("constants", named, "numbers with names in `energy`, none without this list");
}

void declare_bending(Options& options, deck::Section& section) {
  if (!section.given("bending number")) options.bending_modulus = 0;
  section.key("bending modulus", options.bending_modulus, deck::not_negative(), "force x length",
              "E_b of Helfrich's energy; 0: no resistance to bending");
  section.key("bending number", options.bending_number, deck::not_negative(), "1",
              "E_b/(G_s R_C^2), instead of `bending modulus`; over the surface tension for a drop");
  if (section.given("spontaneous curvature")) options.bending_reference = "flat";
  section.key("bending reference", options.bending_reference, deck::Choice{"unstressed", "flat"},
              "curvature at which no bending moment acts: that of the unstressed surface, or, `flat`, the spontaneous curvature everywhere");
  section.key("spontaneous curvature", options.spontaneous_curvature, deck::any(), "1/length",
              "c0 of Helfrich's energy (3.8), where the bending reference is `flat`: a sum of principal curvatures, positive where the surface is "
              "bulged outwards; 0 if not given");
  section.key("area difference modulus", options.leaf_modulus, deck::not_negative(), "1",
              "kbar/E_b of area-difference elasticity (3.27): the two leaves of a bilayer slide on each other, but keep the number of their "
              "molecules; 0: none");
  section.key("area difference", options.leaf_difference, deck::positive(), "1",
              "N0/(8 pi R): the difference of the areas of leaves without stress over that of a sphere of the area A0 = 4 pi R^2; if not given, the "
              "unstressed surface's own");
}

void check_energy(const Options& options) {
  const std::string other = " belongs to Membrane/law `expression`, but Membrane/law is `" + options.law + "`.";
  if (options.energy.has_value() != (options.law == "expression"))
    throw UserError(options.energy ? "Membrane/energy" + other
                                   : "Membrane/law `expression` needs Membrane/energy, the strain energy over G_s in I1 and I2.");
  if (!options.energy && !options.constants.empty()) throw UserError("Membrane/constants" + other);
  options.strain_energy();
}

}  // namespace

void Options::declare(deck::Section& section) {
  section.key("law", law, deck::Choice{"neo-Hookean", "Skalak", "Mooney-Rivlin", "Evans-Skalak", "expression", "surface tension"},
              "constitutive law (3.3): rubber of constant volume, `neo-Hookean` (P-7) or `Mooney-Rivlin`; resistance to a change of area, "
              "`Skalak` (P-8) or `Evans-Skalak`; an `expression` of your own, the `energy`; or a fluid interface (3.4)");
  declare_energy(*this, section);
  if (!section.given("shear modulus") && !section.given("surface tension")) capillary_number = 0.3;
  section.key("capillary number", capillary_number, deck::positive(), "1",
              "Ca = viscosity x rate x R_C / G_s (over the surface tension for a drop); R_C: radius of the sphere of equal volume, rate: "
              "Flow/shear rate, or the largest singular value of Flow/gradient. 0.3 if no alternative is given");
  section.key("shear modulus", shear_modulus, deck::positive(), "force/length", "G_s, instead of `capillary number`");
  section.key("surface tension", surface_tension, deck::positive(), "force/length", "of a drop, instead of `capillary number`");
  if (dilates()) area_dilatation = 1.0;
  section.key("area dilatation", area_dilatation, deck::not_negative(), "1",
              "C of the laws `Skalak` and `Evans-Skalak`, whose area modulus is (1 + 2 C) G_s for small strains; 1 if not given");
  section.key("area points", area_order, deck::between(0, 8), "1",
              "of the laws `Skalak` and `Evans-Skalak`: Gauss points a direction of an element at which their resistance to a change of area is "
              "integrated; 1 for C of 50 and more, whose area no mesh can keep at 16 points an element without locking; 0: as the rest of the law");
  section.key("global area dilatation", global_area_dilatation, deck::not_negative(), "1",
              "K/G_s of a resistance to a change of the whole area, K (A - A0)^2/(2 A0), A0 the unstressed surface's (3.26), beside what the law "
              "resists in each place; K over the surface tension for a drop, with bending a vesicle; 0: none. What is left of the change falls "
              "like 1/K; beyond some 1e4 steps become many");
  section.key("neo-Hookean share", neo_hookean_share, deck::between(0, 1), "1",
              "m of the law `Mooney-Rivlin`: 1 is the neo-Hookean one; what is left of 1 hardens");
  section.key("stress-free shape", stress_free, deck::Choice{"resting", "sphere", "spheroid", "file"},
              "of the membrane: the `resting` shape; an oblate `spheroid` or a `sphere` of the resting shape's area, axis and center, on which "
              "every piece of the membrane has the area that it has at rest; or the surface in the `stress-free file`. Under stress the resting "
              "shape is not one of equilibrium: a run without flow finds that");
  section.key("stress-free reduced volume", reduced_volume, deck::between(0.05, 1), "1",
              "v = 6 sqrt(pi) V/A^1.5 of the stress-free `spheroid`, 1 for a sphere; 0.646 is a red cell's own");
  section.key("stress-free file", stress_free_file, deck::Choice{},
              "name of a Bezier-extraction text (.iga) on the particle's own mesh, looked for as Particle/file");
  section.key("pre-inflation", pre_inflation, deck::between(0.0, 1.0), "1",
              "alpha: the resting shape is the unstressed one blown up by 1 + alpha about its centre; a stress-free shape of its own shrinks by as "
              "much");
  section.key("load", load, deck::Choice{"weak", "strong"},
              "`weak`: by virtual work (3.5); `strong`: the surface divergence (P-3), which the paper shows to fail");
  if (law == "surface tension") load_measure = "current";
  section.key("load measure", load_measure, deck::Choice{"reference", "current"},
              "the weak load per area of the unstressed surface (3.7), or of the current one (3.6), the paper's and a drop's");
  declare_bending(*this, section);
  section.key("shear viscosity", viscosity.shear, deck::not_negative(), "viscosity x length",
              "eta_s of a membrane, in parallel with its elasticity, or of a drop's interface (3.10); the velocity then solves a system");
  section.key("dilatational viscosity", viscosity.dilatational, deck::not_negative(), "viscosity x length",
              "kappa_s: resistance of the membrane or interface to the rate at which its area changes");
  section.key("relaxation time", relaxation_time, deck::positive(), "time",
              "T: the membrane forgets within it what its viscosity resists: springs eta_s/T and kappa_s/T in series with the dashpots, a Maxwell "
              "element (3.23) beside the elastic membrane; if not given, the dashpots are alone (Kelvin and Voigt)");
  section.optional_section("forces", forces, "forces on patches of the membrane, none without this list");
}

void Options::check() const {
  refuse(bending_modulus && bending_number, "Membrane/bending modulus", "Membrane/bending number", "give one of them");
  refuse(bending(1, 1) > 0 && load == "strong", std::string("Membrane/bending ") + (bending_number ? "number" : "modulus"),
         "Membrane/load `strong`", "bending exists in the weak form only");
  refuse(capillary_number && shear_modulus, "Membrane/capillary number", "Membrane/shear modulus", "give one of them");
  refuse(capillary_number && surface_tension, "Membrane/capillary number", "Membrane/surface tension", "give one of them");
  refuse(shear_modulus && law == "surface tension", "Membrane/shear modulus", "Membrane/law `surface tension`", "give Membrane/surface tension");
  refuse(surface_tension && law != "surface tension", "Membrane/surface tension", "Membrane/law `" + law + "`", "give Membrane/shear modulus");
  if (area_dilatation && !dilates())
    throw UserError("Membrane/area dilatation belongs to Membrane/law `Skalak` and `Evans-Skalak`, but Membrane/law is `" + law + "`.");
  if (area_order > 0 && !dilates())
    throw UserError("Membrane/area points belongs to Membrane/law `Skalak` and `Evans-Skalak`, but Membrane/law is `" + law + "`.");
  refuse(area_order > 0 && load == "strong", "Membrane/area points", "Membrane/load `strong`", "nothing is integrated there");
  refuse(global_area_dilatation > 0 && load == "strong", "Membrane/global area dilatation", "Membrane/load `strong`", "it acts by virtual work");
  if (neo_hookean_share && law != "Mooney-Rivlin")
    throw UserError("Membrane/neo-Hookean share belongs to Membrane/law `Mooney-Rivlin`, but Membrane/law is `" + law + "`.");
  if (!neo_hookean_share && law == "Mooney-Rivlin") throw UserError("Membrane/law `Mooney-Rivlin` needs Membrane/neo-Hookean share.");
  check_energy(*this);
  refuse(law == "surface tension" && pre_inflation != 0.0, "Membrane/pre-inflation", "Membrane/law `surface tension`",
         "a fluid interface has no unstressed shape");
  check_stress_free(*this);
  refuse(spontaneous_curvature && bending_reference == "unstressed", "Membrane/spontaneous curvature", "Membrane/bending reference `unstressed`",
         "one says the curvature");
  if (spontaneous_curvature && bending(1, 1) == 0)
    throw UserError("Membrane/spontaneous curvature needs Membrane/bending modulus or Membrane/bending number.");
  if (leaf_modulus > 0 && bending(1, 1) == 0)
    throw UserError("Membrane/area difference modulus needs Membrane/bending modulus or Membrane/bending number.");
  if (leaf_difference && leaf_modulus == 0) throw UserError("Membrane/area difference needs Membrane/area difference modulus.");
  forces.check();
  refuse(relaxation_time && law == "surface tension", "Membrane/relaxation time", "Membrane/law `surface tension`",
         "the viscosity of a fluid interface has no memory, because the interface has no stress-free shape");
  if (relaxation_time && !viscosity.any())
    throw UserError("Membrane/relaxation time needs Membrane/shear viscosity or Membrane/dilatational viscosity: it is theirs.");
  refuse(viscosity.any() && load == "strong", std::string("Membrane/") + (viscosity.shear > 0 ? "shear" : "dilatational") + " viscosity",
         "Membrane/load `strong`", "viscosity is part of the weak load");
  refuse(!forces.all.empty() && law == "surface tension", "Membrane/forces", "Membrane/law `surface tension`",
         "nothing holds on to a fluid interface");
  refuse(!forces.all.empty() && load == "strong", "Membrane/forces", "Membrane/load `strong`", "the forces are part of the weak load");
  if (law == "surface tension" && load_measure == "reference" && load == "weak")
    throw UserError("Membrane/law `surface tension` needs Membrane/load measure `current`: a fluid interface has no unstressed shape.");
}

std::shared_ptr<const StrainEnergy> Options::strain_energy() const {
  if (!energy) return nullptr;
  return std::make_shared<const StrainEnergy>("Membrane/energy", *energy, constants);
}

double Options::modulus(double viscosity, double rate, double radius) const {
  if (shear_modulus) return *shear_modulus;
  if (surface_tension) return *surface_tension;
  if (rate == 0.0)
    throw UserError("Membrane/capillary number needs a flow with a gradient: give Membrane/" +
                    std::string(law == "surface tension" ? "surface tension" : "shear modulus") + " instead.");
  return viscosity * rate * radius / capillary_number.value();
}

double Options::bending(double modulus, double radius) const {
  return bending_number ? *bending_number * modulus * radius * radius : bending_modulus.value_or(0);
}

void DirectSolverOptions::declare(deck::Section& section) {
  section.key("sparse systems", sparse_systems, deck::Choice{"auto", "direct", "iterative"},
              "mass and collocation matrices: factored by the `direct solver`; `iterative`: BiCGSTAB with incomplete factors, to rounding, whose "
              "set-up grows with the number of control points where a direct solver's grows like its power 1.7; `auto`: that from 5000 unknowns on");
  section.key("direct solver", name, deck::Choice{},
              "Amesos2's name of the solver of the sparse systems: `KLU2`, or another that it was built with");
  section.foreign("Amesos2", amesos2, "list handed to the direct solver as it is");
}

}  // namespace tanktread::membrane
