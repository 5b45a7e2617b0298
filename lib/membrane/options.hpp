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

/// Options of the bending resistance among the keys `Membrane/*`.
struct BendingOptions {
  double leaf_modulus = 0;                  ///< modulus kbar of the area difference of a bilayer's leaflets (3.27) divided by the bending modulus E_b
  std::optional<double> leaf_difference;    ///< stress-free area difference of the leaflets, divided by the area difference of a sphere of equal area
  std::optional<double> bending_modulus;   ///< bending modulus E_b, force x length; no bending if neither E_b nor bending_number is given
  std::optional<double> bending_number;    ///< E_b/(G_s R_C^2), or E_b/(sigma R_C^2)
  std::string bending_reference = "unstressed";  ///< surface without bending moment: `unstressed` (curved as the unstressed surface) or `flat`
                                                 ///< (curvature c0 everywhere)
  std::optional<double> spontaneous_curvature;   ///< spontaneous curvature c0 if the bending reference is flat, 1/length
};

/// Options of the membrane: the keys `Membrane/*`.
struct Options : BendingOptions {
  std::string law = "neo-Hookean";         ///< neo-Hookean, Skalak, Mooney-Rivlin, Evans-Skalak (all 3.3), expression, surface tension (3.4)
  std::optional<double> capillary_number;  ///< Ca = mu rate R_C/G_s, for a drop mu rate R_C/sigma (see modulus()); 0.3 if the deck gives none of Ca,
                                           ///< G_s and sigma
  std::optional<double> shear_modulus;     ///< G_s, force/length
  std::optional<double> surface_tension;   ///< sigma, force/length
  std::optional<double> area_dilatation;   ///< area dilatation C of the laws Skalak and Evans-Skalak, 1 if the deck does not give it; not set for
                                           ///< other laws
  double global_area_dilatation = 0;        ///< modulus K that keeps the total area (3.26), divided by the shear modulus G_s
  std::optional<double> neo_hookean_share;  ///< fraction m of the neo-Hookean term; only for the law Mooney-Rivlin
  std::optional<std::string> energy;        ///< strain energy Psi/G_s as an expression in I1, I2 and J; only for the law `expression`
  std::map<std::string, double> constants;  ///< named constants in `energy`
  std::string stress_free = "resting";     ///< stress-free shape before pre-inflation: resting, sphere, spheroid, file
  std::optional<double> reduced_volume;    ///< reduced volume of a stress-free spheroid; only for that shape
  std::optional<std::string> stress_free_file;
  int area_order = 0;                      ///< number of Gauss points per direction for the area elasticity; 0: the Gauss points of the other terms
  double pre_inflation = 0.0;              ///< inflation alpha: the unstressed shape is X = centre + (x - centre)/(1 + alpha), with x on the shape
                                           ///< `stress_free`
  std::string load = "weak";               ///< form of the load: weak (virtual work, 3.5) or strong (-div_s tau)
  std::string load_measure = "reference";  ///< area to which the load per area refers: reference (unstressed, 3.7) or current (3.6)
  SurfaceViscosity viscosity;                            ///< eta_s, kappa_s (3.10)
  std::optional<double> relaxation_time;                 ///< relaxation time T of a Maxwell element (3.23), whose viscosities are `viscosity`
  PatchForces forces;                            ///< forces that hold or pull the membrane

  void declare(deck::Section& section);

  /// Throws UserError, with a one-sentence message, if keys contradict each other.
  void check() const;
  void reject(Rejections& to) const;  ///< adds the combinations of keys that are not allowed to the list `to`

  std::shared_ptr<const StrainEnergy> strain_energy() const;  ///< energy of the law `expression`, otherwise null; throws UserError if it is invalid

  bool fluid_interface() const { return law == "surface tension"; }  ///< returns true for the interface of a drop, false for an elastic membrane
  /// returns whether the law has the parameter C, the resistance to area changes
  bool dilates() const { return law == "Skalak" || law == "Evans-Skalak"; }

  /// Returns the shear modulus G_s, or the tension sigma of an interface, from the key that was given. `viscosity`: mu, `rate`: rate of the flow,
  /// `radius`: particle radius R_C.
  double modulus(double viscosity, double rate, double radius) const;

  /// Returns the bending modulus E_b from the key that was given. `modulus`: G_s or sigma, `radius`: particle radius R_C.
  double bending(double modulus, double radius) const;
};

/// Options of the solver of sparse systems (mass and collocation matrices): the keys `Solvers/*`.
struct DirectSolverOptions {
  std::string sparse_systems = "auto";              ///< direct, iterative, auto
  std::string name = "KLU2";                        ///< name of the solver in Amesos2
  std::shared_ptr<Teuchos::ParameterList> amesos2;  ///< parameter list of Amesos2, passed on unchanged

  void declare(deck::Section& section);
};

}  // namespace tanktread::membrane
