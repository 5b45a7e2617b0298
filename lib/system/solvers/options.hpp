#pragma once

#include <memory>
#include <optional>
#include <string>

#include "membrane/options.hpp"

namespace tanktread::coupling {

/// How the volume of the particle is kept: `Volume/*` of the deck.
struct VolumeOptions {
  /// exact: no net flux in every evaluation and the volume restored after every step; flux: the former (2.8); none: neither.
  std::string constraint = "exact";

  void declare(deck::Section& section);
};

/// How the control points of an interface move along it, which is free where there is no membrane: `Interface/*` of the deck.
struct InterfaceOptions {
  /// material: with the fluid; normal: across the surface only; relaxed: across with the fluid, along so that elements keep their shape.
  /// Empty: relaxed for a surface tension, material otherwise.
  std::optional<std::string> motion;
  double relaxation = 1;  ///< speed of the relaxing motion: that of an elastic surface at capillary number 1 / relaxation

  void declare(deck::Section& section);
};

/// The iterative solver of one kind of system: `Solvers/<system>` of the deck.
struct IterativeOptions {
  std::optional<std::string> solver{};            ///< Belos' name; that of SolverOptions where it is not given
  std::shared_ptr<Teuchos::ParameterList> belos{};  ///< its list, as it is; that of SolverOptions where neither this nor the name is given
  std::string preconditioner = "own";             ///< own, none, neumann, recycled
  std::string path = "Solvers";                   ///< of its list in the deck
  int restart = 100;                              ///< of GMRES, where the list does not say: all these vectors are allocated in each solve

  void declare(deck::Section& section);
};

/// The solvers of the linear systems: `Solvers/*` of the deck.
struct SolverOptions {
  std::string krylov = "GMRES";                   ///< Belos' name of the iterative solver, of all systems that have none of their own
  std::shared_ptr<Teuchos::ParameterList> belos;  ///< its list, as it is
  IterativeOptions velocity, traction;
  IterativeOptions implicit_step{.restart = 30};  ///< three iterations are usual
  IterativeOptions spectrum{.restart = 30}, steady{.restart = 30};
  std::shared_ptr<Teuchos::ParameterList> nox;    ///< list of the nonlinear solver of crank-nicolson, as it is
  double tolerance = 1e-8;                        ///< relative residual of systems that a velocity or a traction comes from
  std::string double_layer = "auto";              ///< assembled once a velocity, for all iterations; matrix-free: summed in each of them;
                                                  ///< auto: the latter where far sums are taken by clusters
  std::string tube = "schur";                     ///< what is solved for in a tube: v with the wall eliminated; all blocks (BlockForm)
  std::string wall = "auto";                      ///< of a channel: factored, iterative, or auto: the latter where factors are large (Wall)
  std::string rigid_bodies = "second kind";       ///< equation of those among others (RigidParticles), or first kind, of them alone (RigidTractions)
  std::string projection = "collocation";         ///< of velocities onto the splines: collocation, least squares (VelocityProjection)
  std::string frozen_operator = "nodal";          ///< the single layer of the Jacobian: a sum over nodes, or assembled
  membrane::DirectSolverOptions direct;

  /// What `double layer` means where far sums are taken by clusters, or not.
  bool assembled(bool by_clusters) const { return double_layer == "assembled" || (double_layer == "auto" && !by_clusters); }

  /// The system's own solver, or that of all.
  IterativeOptions of(IterativeOptions system) const;

  void declare(deck::Section& section);
};

}  // namespace tanktread::coupling
