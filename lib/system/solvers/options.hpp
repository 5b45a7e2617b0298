#pragma once
// Options of the linear and nonlinear solvers.

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "membrane/options.hpp"

namespace tanktread::coupling {

/// Options `Solvers/<system>` of the deck: the iterative solver of one kind of system.
struct IterativeOptions {
  std::optional<std::string> solver{};            ///< Belos' name of the solver; if not set, SolverOptions::krylov
  std::shared_ptr<Teuchos::ParameterList> belos{};  ///< parameter list of the Belos solver, passed unchanged. If neither this list nor `solver` is
                                                    ///< set, the parameter list of SolverOptions is used
  std::string preconditioner = "own";             ///< own, none, recycled
  std::string path = "Solvers";                   ///< path of these options in the deck
  int restart = 100;  ///< restart length of GMRES, if the solver's parameter list does not set it; each solve allocates this number of vectors

  void declare(deck::Section& section);
};

/// Integral equation of rigid bodies: `second_kind` for the density of a double layer (RigidParticles), `first_kind` for the tractions
/// (RigidTractions), `automatic` for the choice by Scene::by_tractions().
enum class BodyEquation { automatic, second_kind, first_kind };

/// Options `Solvers/*` of the deck: the solvers of the linear systems.
struct SolverOptions {
  std::string krylov = "GMRES";                   ///< Belos' name of the iterative solver of all systems that do not set their own
  std::shared_ptr<Teuchos::ParameterList> belos;  ///< parameter list of the solver `krylov`, passed unchanged to Belos
  IterativeOptions velocity, traction;
  IterativeOptions implicit_step{.restart = 30};  ///< short restart length, because three iterations are typical
  IterativeOptions spectrum{.restart = 30}, steady{.restart = 30};
  std::shared_ptr<Teuchos::ParameterList> nox;    ///< parameter list of the nonlinear solver (Steady, Time/scheme), passed unchanged to NOX
  double tolerance = 1e-8;                        ///< relative residual of the systems for velocities or tractions
  std::string double_layer = "auto";  ///< double layer. assembled: once per velocity evaluation. matrix-free: summed in each iteration. auto:
                                      ///< matrix-free if far sums use a treecode, unless there are rigid bodies and the matrix is small, or if
                                      ///< few iterations are needed
  bool in_lattice = false;                        ///< true in a Domain without a tube, where the double layer is always matrix-free
  bool in_duct = true;                            ///< false in scenes without a tube or channel, where `tube` and `wall` have no effect
  std::string tube = "schur";                     ///< unknowns in a tube. schur: velocity, with the wall tractions eliminated. Other values:
                                                  ///< preconditioner of one system for all unknowns (DuctWall)
  std::string volume = "auto";                    ///< constant volumes in the system for velocities: projection, or multipliers as unknowns. auto:
                                                  ///< multipliers only if the wall tractions are unknowns
  std::string wall = "auto";                      ///< solver for the wall of a channel: factored, iterative, or auto (see WallSolver)
  bool eliminates_walls() const { return tube == "schur"; }  ///< returns whether the tractions on the wall of a tube are eliminated

  /// Returns whether the multipliers of the volume constraints are unknowns. `walls`: whether the wall tractions are unknowns.
  bool keeps_multipliers(bool walls) const { return volume == "multipliers" || (volume == "auto" && walls); }
  BodyEquation rigid_bodies = BodyEquation::automatic;
  std::string projection = "collocation";         ///< projection of velocities onto the splines: collocation or least squares (VelocityProjection)
  std::string frozen_operator = "auto";           ///< single layer of the Jacobian: nodal (NodalOperator), assembled (FrozenOperator), or auto
  membrane::DirectSolverOptions direct;

  /// Returns the options of all kinds of systems.
  std::array<const IterativeOptions*, 5> systems() const { return {&velocity, &traction, &implicit_step, &spectrum, &steady}; }

  /// Returns whether the layers of the system for the velocity are assembled if there is no lattice. On lattices, layers are never assembled.
  /// `sums_pay_off`: whether sums in each iteration are faster than assembly: if a treecode evaluates them, or if there are few iterations.
  bool assembled(bool sums_pay_off) const { return double_layer == "assembled" || (double_layer == "auto" && !sums_pay_off); }

  static constexpr int nodes_worth_a_tree = 4000;  ///< number of nodes above which the treecode of NodalOperator is faster than its direct sum;
                                                   ///< chosen from measurements on capsules in shear flow

  /// Returns whether the single layer of the Jacobian is assembled for n control points. `contrast`: whether a deformable particle has a viscosity
  /// ratio other than 1. The double layer of the Jacobian is then assembled in any case, and with `auto` the single layer is assembled with it if
  /// there are too few points for a treecode.
  bool assembles_frozen(bool contrast, double n) const {
    return frozen_operator == "assembled" || (frozen_operator == "auto" && contrast && n < nodes_worth_a_tree);
  }

  /// Returns the options `system` of one kind of system, with missing options filled in. If `system` does not set a solver, the solver is `krylov`.
  /// If it sets neither a solver nor a parameter list, the parameter list is `belos`.
  IterativeOptions of(IterativeOptions system) const;

  void declare(deck::Section& section);
};

/// Solves a small test system with each solver of Belos, Amesos2 or NOX whose name or parameter list the deck sets. NOX uses the method
/// `nonlinear_solver` (Time/nonlinear solver). Throws UserError, naming the key, if a solver or a parameter list fails, or if NOX does not use a
/// parameter. Collective.
void try_solvers(const SolverOptions& solvers, const std::string& nonlinear_solver);

}  // namespace tanktread::coupling
