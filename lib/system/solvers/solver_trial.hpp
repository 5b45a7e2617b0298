#pragma once
// Whether the libraries take what a deck asks of them, before a run is begun.

#include <string>

#include "system/solvers/options.hpp"

namespace tanktread::coupling {

/// Solves a system of some dozens of unknowns with each solver that the deck names or gives a list: Belos', Amesos2's, and NOX' with the method
/// `nonlinear_solver` (Time/nonlinear solver). Throws UserError, naming the key, for a solver or a list that fails there, and for a parameter that
/// NOX does not look at. Collective.
void try_solvers(const SolverOptions& solvers, const std::string& nonlinear_solver);

}  // namespace tanktread::coupling
