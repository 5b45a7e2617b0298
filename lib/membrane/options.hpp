#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "deck/forward.hpp"
#include "membrane/laws.hpp"
#include "membrane/patch_forces.hpp"

namespace tanktread::membrane {

class StrainEnergy;

/// The membrane: `Membrane/*` of the deck.
struct Options {
  std::string law = "neo-Hookean";         ///< neo-Hookean (P-7), Skalak (P-8), Mooney-Rivlin, Evans-Skalak, expression, surface tension (3.4)
  std::optional<double> capillary_number;  ///< Ca = mu rate R_C / G_s, or over sigma; 0.3 if none of the three is given
  std::optional<double> shear_modulus;     ///< G_s, force/length
  std::optional<double> surface_tension;   ///< sigma, force/length
  std::optional<double> area_dilatation;   ///< C of Skalak, Evans-Skalak; set for these laws, 1 if not given, empty otherwise
  double global_area_dilatation = 0;        ///< K/G_s of the whole area (3.26)
  double leaf_modulus = 0;                  ///< kbar/E_b of the difference between the leaves' areas (3.27)
  std::optional<double> leaf_difference;    ///< without stress, over that of a sphere
  std::optional<double> neo_hookean_share;  ///< m of Mooney-Rivlin; given for this law alone
  std::optional<std::string> energy;        ///< Psi/G_s of the law `expression`, a text in I1, I2 and J; given for this law alone
  std::map<std::string, double> constants;  ///< of that text
  std::string stress_free = "resting";     ///< the stress-free shape before pre-inflation: resting, sphere, spheroid, file
  std::optional<double> reduced_volume;    ///< of the stress-free spheroid; given for it alone
  std::optional<std::string> stress_free_file;
  int area_order = 0;                      ///< Gauss points a direction of the area's elasticity; 0: as for the rest
  double pre_inflation = 0.0;              ///< alpha: unstressed X = centre + (x - centre)/(1 + alpha)
  std::string load = "weak";               ///< weak: virtual work (3.5); strong: -div_s tau (P-3)
  std::string load_measure = "reference";  ///< the weak load per area of the unstressed surface (3.7) or of the current one (3.6)
  std::optional<double> bending_modulus;   ///< E_b, force x length; 0 if neither is given: none
  std::optional<double> bending_number;    ///< E_b/(G_s R_C^2), or over sigma R_C^2
  std::string bending_reference = "unstressed";  ///< curvature without bending moment: unstressed (of the unstressed surface) or flat
  std::optional<double> spontaneous_curvature;   ///< c0 of a membrane whose bending reference is flat, 1/length
  SurfaceViscosity viscosity;                            ///< eta_s, kappa_s (3.10)
  std::optional<double> relaxation_time;                 ///< T of a Maxwell element (3.23), whose viscosities these are then
  PatchForces forces;                            ///< by which it is held or pulled

  void declare(deck::Section& section);

  /// One sentence (UserError) for keys that contradict each other.
  void check() const;

  std::shared_ptr<const StrainEnergy> strain_energy() const;  ///< of the law `expression`, nothing of others; UserError where it is none

  bool dilates() const { return law == "Skalak" || law == "Evans-Skalak"; }  ///< whether the law has a C

  /// G_s, or sigma of a surface tension, from whichever key was given; `viscosity` mu, `rate` of the flow, `radius` R_C.
  double modulus(double viscosity, double rate, double radius) const;

  /// E_b, from whichever key was given; `modulus` G_s or sigma, `radius` R_C.
  double bending(double modulus, double radius) const;
};

/// The solver of the sparse systems (mass matrices, collocation matrix): keys of `Solvers/*`.
struct DirectSolverOptions {
  std::string sparse_systems = "auto";              ///< direct, iterative, auto
  std::string name = "KLU2";                        ///< as Amesos2 names it
  std::shared_ptr<Teuchos::ParameterList> amesos2;  ///< its list, as it is

  void declare(deck::Section& section);
};

}  // namespace tanktread::membrane
