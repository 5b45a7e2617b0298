#include "membrane/options.hpp"

#include "base/errors.hpp"
#include "base/rejections.hpp"
#include "deck/section.hpp"
#include "membrane/strain_energy.hpp"

namespace tanktread::membrane {

namespace {

void check_stress_free(const Options& options) {
  refuse(options.fluid_interface() && options.stress_free != "resting", "Membrane/stress-free shape",
         "Membrane/law `surface tension`", "a fluid interface has no stress-free shape");
  const std::string shape = "Membrane/stress-free shape `", chosen = "`, not to `" + options.stress_free + "`.";
  if (options.reduced_volume.has_value() != (options.stress_free == "spheroid"))
    throw UserError(options.reduced_volume ? "Membrane/stress-free reduced volume belongs to " + shape + "spheroid" + chosen
                                           : shape + "spheroid` needs Membrane/stress-free reduced volume.");
  if (options.stress_free_file.has_value() != (options.stress_free == "file"))
    throw UserError(options.stress_free_file
                        ? "Membrane/stress-free file belongs to " + shape + "file" + chosen
                        : shape + "file` needs Membrane/stress-free file, the path of a file in Bezier-extraction format (.iga).");
}

/// Named constants of the strain energy, `Membrane/constants/<name>`.
struct Constants {
  std::map<std::string, double>& all;

  void declare(deck::Section& section) {
    section.each("value of a named constant in Membrane/energy", [this](const std::string& name, deck::Section& inner) {
      if (!inner.documenting() && !inner.given("value"))
        throw UserError(inner.path("value") + " is missing: it is the number that `" + name + "` stands for.");
      inner.key("value", all[name], deck::any(), "1",
                "value of the constant with the name of this section, in Membrane/energy (required; the default is not used)");
    });
    if (section.documenting()) all.clear();
  }
};

void declare_energy(Options& options, deck::Section& section) {
  section.key("energy", options.energy, deck::Choice{},
              "strain energy per unstressed area divided by the surface shear modulus, for Membrane/law `expression`. It is an expression in "
              "I1 = l1^2 + l2^2 - 2, I2 = l1^2 l2^2 - 1 (l1, l2: principal stretches), J = l1 l2, numbers and Membrane/constants, with + - * "
              "/ ^ exp log sqrt and parentheses. It is differentiated exactly. `(I1 - 1 + 1/(I2 + 1))/2` is the law `neo-Hookean`");
  Constants named{options.constants};
  section.optional_section("constants", named, "named constants for Membrane/energy; none without this section");
}

void declare_bending(Options& options, deck::Section& section) {
  if (!section.given("bending number")) options.bending_modulus = 0;
  section.key("bending modulus", options.bending_modulus, deck::not_negative(), "force x length",
              "bending modulus E_b of Helfrich's bending energy of the membrane; 0: no resistance to bending");
  section.key("bending number", options.bending_number, deck::not_negative(), "1",
              "dimensionless bending modulus E_b/(G_s R_C^2) of the membrane, instead of `bending modulus`. G_s: surface shear modulus, "
              "for a drop the surface tension. R_C: radius of the sphere with the particle's volume");
  if (section.given("spontaneous curvature") || options.fluid_interface()) options.bending_reference = "flat";
  section.key("bending reference", options.bending_reference, deck::Choice{"unstressed", "flat"},
              "curvature at which the bending moment of the membrane vanishes. `unstressed`: curvature of the unstressed surface. `flat`: "
              "Membrane/spontaneous curvature everywhere, by default 0; default with `spontaneous curvature` and for Membrane/law "
              "`surface tension`");
  if (options.bending(1, 1) == 0) section.without_effect({"bending reference"}, "without bending modulus or bending number");
  section.key("spontaneous curvature", options.spontaneous_curvature, deck::any(), "1/length",
              "spontaneous curvature c0 of the membrane in Helfrich's bending energy (3.8), with Membrane/bending reference `flat`: sum of "
              "the principal curvatures, positive where the surface bulges outwards; 0 if not given");
  section.key(
      "area difference modulus", options.leaf_modulus, deck::not_negative(), "1",
      "area-difference modulus kbar of a lipid bilayer divided by its bending modulus E_b (3.27). The two leaflets of the bilayer slide on "
      "each other, but each keeps its number of molecules, so that a change of their area difference costs energy; 0: no such energy");
  section.key("area difference", options.leaf_difference, deck::positive(), "1",
              "preferred difference of the areas of a bilayer's two leaflets, at which the energy of Membrane/area difference modulus "
              "vanishes, divided by the area difference of a sphere of the same area; if not given, the value of the unstressed surface");
}

void declare_stress_free(Options& options, deck::Section& section) {
  section.key("stress-free shape", options.stress_free, deck::Choice{"resting", "sphere", "spheroid", "file"},
              "shape in which the membrane has no stress. `resting`: the resting shape. `sphere` or `spheroid` (oblate): with the area, axis "
              "and centre of the resting shape; every piece of the membrane has the same area as at rest. `file`: the surface in `stress-free "
              "file`. If it is not `resting`, the resting shape is not in equilibrium; a run without flow finds the equilibrium shape");
  section.key("stress-free reduced volume", options.reduced_volume, deck::between(0.05, 1), "1",
              "reduced volume 6 sqrt(pi) V/A^1.5 (V: volume, A: area) of the stress-free `spheroid`: 1 for a sphere, 0.646 for a red cell");
  section.key("stress-free file", options.stress_free_file, deck::Choice{},
              "path of a file with the stress-free surface of the membrane in Bezier-extraction format (.iga), on the same mesh as the "
              "particle. A relative path is looked up in the working directory, then in the directory of the deck");
  section.key("pre-inflation", options.pre_inflation, deck::between(0.0, 1.0), "1",
              "relative inflation alpha of a capsule: the shape of section Particle is the unstressed shape enlarged by 1 + alpha about its "
              "centre, so that the membrane is under tension. A `stress-free shape` other than `resting` is shrunk by this factor");
}

void check_energy(const Options& options) {
  const std::string other = " belongs to Membrane/law `expression`, but Membrane/law is `" + options.law + "`.";
  if (options.energy.has_value() != (options.law == "expression"))
    throw UserError(
        options.energy
            ? "Membrane/energy" + other
            : "Membrane/law `expression` needs Membrane/energy, the strain energy divided by G_s as an expression in I1 and I2.");
  if (!options.energy && !options.constants.empty()) throw UserError("Membrane/constants" + other);
  options.strain_energy();
}

}  // namespace

void Options::declare(deck::Section& section) {
  section.key("law", law, deck::Choice{"neo-Hookean", "Skalak", "Mooney-Rivlin", "Evans-Skalak", "expression", "surface tension"},
              "constitutive law of the membrane (equation 3.3). `neo-Hookean`, `Mooney-Rivlin`: thin sheet of incompressible rubber. "
              "`Skalak`, `Evans-Skalak`: with a separate resistance to a change of area. `expression`: user-defined strain energy "
              "Membrane/energy. `surface tension`: fluid interface of a drop, without elasticity (3.4)");
  declare_energy(*this, section);
  if (!section.given("shear modulus") && !section.given("surface tension")) capillary_number = 0.3;
  section.key("capillary number", capillary_number, deck::positive(), "1",
              "capillary number viscosity x U/G_s, with the surface shear modulus G_s (for a drop the surface tension). U: in a duct the mean "
              "velocity, otherwise rate x R_C. rate: Flow/shear rate, or the largest singular value of Flow/gradient. R_C: radius of the "
              "sphere with the particle's volume. 0.3 if neither this, `shear modulus` nor `surface tension` is given");
  section.key("shear modulus", shear_modulus, deck::positive(), "force/length",
              "surface shear modulus G_s of the membrane, instead of `capillary number`");
  section.key("surface tension", surface_tension, deck::positive(), "force/length", "surface tension of a drop, instead of `capillary number`");
  if (dilates()) area_dilatation = 1.0;
  section.key("area dilatation", area_dilatation, deck::not_negative(), "1",
              "constant C of the laws `Skalak` and `Evans-Skalak`: at small strains, area modulus / shear modulus = 1 + 2 C; 1 if not given");
  section.key("area points", area_order, deck::between(0, 8), "1",
              "number of Gauss points per direction of an element at which the area resistance of the laws `Skalak` and `Evans-Skalak` is "
              "evaluated; 0: the points that the rest of the law uses. Use 1 if Membrane/area dilatation is 20 or more, because the mesh locks "
              "(is too stiff) if the area is resisted at all 16 points of an element");
  section.key(
      "global area dilatation", global_area_dilatation, deck::not_negative(), "1",
      "dimensionless modulus K that keeps the total area A, as of a vesicle (a drop with bending): the energy K G (A - A0)^2/(2 A0) is added "
      "to the law (3.26). G: surface shear modulus, for a drop the surface tension. A0: area of the unstressed surface, for a drop of its "
      "resting shape. The relative area change decreases like 1/K; above about 1e4 many steps are needed. 0: no such energy");
  section.key("neo-Hookean share", neo_hookean_share, deck::between(0, 1), "1",
              "fraction m of the neo-Hookean term in the energy of Membrane/law `Mooney-Rivlin` (required for this law); the smaller it is, "
              "the stiffer the membrane at large stretch");
  declare_stress_free(*this, section);
  section.key("load", load, deck::Choice{"weak", "strong"},
              "method of computing the load (force per area) of the membrane on the fluid. `weak`: by virtual work (3.5). `strong`: by the "
              "surface divergence of the tensions, which fails as Maestre et al. (2017) show");
  if (fluid_interface()) load_measure = "current";
  section.key("load measure", load_measure, deck::Choice{"reference", "current"},
              "area to which the membrane load (force per area) refers, with Membrane/load `weak`. `reference`: area of the unstressed surface "
              "(3.7). `current`: current area (3.6), as by Maestre et al. (2017); default for drops");
  declare_bending(*this, section);
  section.key("shear viscosity", viscosity.shear, deck::not_negative(), "viscosity x length",
              "surface shear viscosity eta_s of a membrane, in parallel with its elasticity, or of a drop's interface (3.10). If it is not "
              "0, every evaluation of the velocity needs the solution of a linear system");
  section.key("dilatational viscosity", viscosity.dilatational, deck::not_negative(), "viscosity x length",
              "surface dilatational viscosity kappa_s of the membrane or interface: its resistance to the rate of change of its area");
  section.key("relaxation time", relaxation_time, deck::positive(), "time",
              "relaxation time T of a viscoelastic membrane: its dashpots `shear viscosity` eta_s and `dilatational viscosity` kappa_s are "
              "in series with springs eta_s/T and kappa_s/T, which gives a Maxwell element (3.23) in parallel with the elastic membrane. If "
              "not given, the dashpots alone are in parallel with the elastic membrane (Kelvin-Voigt)");
  section.optional_section("forces", forces, "forces on patches of the membrane; none without this section");
}

void Options::reject(Rejections& to) const {
  to.pair(fluid_interface() && pre_inflation != 0.0, "Membrane/pre-inflation", "Membrane/law `surface tension`",
         "a fluid interface has no unstressed shape");
  to.pair(bending_reference == "unstressed" && fluid_interface(), "Membrane/bending reference `unstressed`",
          "Membrane/law `surface tension`", "a fluid interface has no unstressed shape, whose curvature it could keep at points that flow");
  to.pair(relaxation_time.has_value() && fluid_interface(), "Membrane/relaxation time", "Membrane/law `surface tension`",
         "the viscosity of a fluid interface has no memory, because the interface has no stress-free shape");
  to.pair(!forces.all.empty() && fluid_interface(), "Membrane/forces", "Membrane/law `surface tension`",
          "a fluid interface has no material patch on which a force could act");
}

void Options::check() const {
  Rejections found;
  reject(found);
  found.throw_if_any();
  refuse(bending_modulus && bending_number, "Membrane/bending modulus", "Membrane/bending number", "give one of them");
  refuse(capillary_number && shear_modulus, "Membrane/capillary number", "Membrane/shear modulus", "give one of them");
  refuse(capillary_number && surface_tension, "Membrane/capillary number", "Membrane/surface tension", "give one of them");
  refuse(shear_modulus && fluid_interface(), "Membrane/shear modulus", "Membrane/law `surface tension`", "give Membrane/surface tension");
  refuse(surface_tension && !fluid_interface(), "Membrane/surface tension", "Membrane/law `" + law + "`", "give Membrane/shear modulus");
  if (area_dilatation && !dilates())
    throw UserError("Membrane/area dilatation belongs to Membrane/law `Skalak` and `Evans-Skalak`, but Membrane/law is `" + law + "`.");
  if (area_order > 0 && !dilates())
    throw UserError("Membrane/area points belongs to Membrane/law `Skalak` and `Evans-Skalak`, but Membrane/law is `" + law + "`.");
  if (neo_hookean_share && law != "Mooney-Rivlin")
    throw UserError("Membrane/neo-Hookean share belongs to Membrane/law `Mooney-Rivlin`, but Membrane/law is `" + law + "`.");
  if (!neo_hookean_share && law == "Mooney-Rivlin") throw UserError("Membrane/law `Mooney-Rivlin` needs Membrane/neo-Hookean share.");
  check_energy(*this);
  check_stress_free(*this);
  refuse(spontaneous_curvature && bending_reference == "unstressed", "Membrane/spontaneous curvature",
         "Membrane/bending reference `unstressed`",
         "both set the curvature at which the bending moment vanishes; give Membrane/bending reference `flat`");
  if (spontaneous_curvature && bending(1, 1) == 0)
    throw UserError("Membrane/spontaneous curvature needs Membrane/bending modulus or Membrane/bending number.");
  if (leaf_modulus > 0 && bending(1, 1) == 0)
    throw UserError("Membrane/area difference modulus needs Membrane/bending modulus or Membrane/bending number.");
  if (leaf_difference && leaf_modulus == 0) throw UserError("Membrane/area difference needs Membrane/area difference modulus.");
  forces.check();
  if (relaxation_time && !viscosity.any())
    throw UserError("Membrane/relaxation time needs Membrane/shear viscosity or Membrane/dilatational viscosity, whose stress it relaxes.");
  if (fluid_interface() && load_measure == "reference" && load == "weak")
    throw UserError("Membrane/law `surface tension` needs Membrane/load measure `current`: a fluid interface has no unstressed shape.");
}

std::shared_ptr<const StrainEnergy> Options::strain_energy() const {
  if (!energy) return nullptr;
  return std::make_shared<const StrainEnergy>("Membrane/energy", *energy, constants);
}

double Options::modulus(double fluid_viscosity, double rate, double radius) const {
  if (shear_modulus) return *shear_modulus;
  if (surface_tension) return *surface_tension;
  if (rate == 0.0)
    throw UserError("Membrane/capillary number needs a flow with a gradient: give Membrane/" +
                    std::string(fluid_interface() ? "surface tension" : "shear modulus") + " instead.");
  return fluid_viscosity * rate * radius / capillary_number.value();
}

double Options::bending(double modulus, double radius) const {
  return bending_number ? *bending_number * modulus * radius * radius : bending_modulus.value_or(0);
}

void DirectSolverOptions::declare(deck::Section& section) {
  section.key("sparse systems", sparse_systems, deck::Choice{"auto", "direct", "iterative"},
              "solver of the sparse linear systems with mass and collocation matrices. `direct`: LU factors by Solvers/direct solver. "
              "`iterative`: BiCGSTAB with incomplete factors, to rounding accuracy, which is faster on large meshes. `auto`: `iterative` "
              "from 5000 unknowns on, and otherwise `direct`");
  section.key("direct solver", name, deck::Choice{},
              "name of the direct solver (LU factors) of the sparse linear systems with mass and collocation matrices, from Amesos2, a "
              "package of Trilinos: `KLU2`, or another one that this build of Amesos2 has");
  section.foreign("Amesos2", amesos2, "parameters that are passed unchanged to the direct solver of Amesos2, a package of Trilinos");
}

}  // namespace tanktread::membrane
