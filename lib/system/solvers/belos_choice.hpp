#pragma once
// A solver of Belos with its parameters, as the deck chooses it.

#include <string>

#include <Teuchos_ParameterList.hpp>
#include <Teuchos_RCP.hpp>

#include "system/solvers/options.hpp"

namespace tanktread::coupling {

struct BelosChoice {
  std::string name;                           ///< name in Belos' factory
  Teuchos::RCP<Teuchos::ParameterList> list;  ///< the deck's parameters, which override the defaults set here
  bool flexible = false;  ///< whether the solver is flexible GMRES, which always needs a preconditioner, at least the identity
};

/// Throws UserError if Belos does not know the name or a parameter.
BelosChoice belos_choice(const IterativeOptions& options);

}  // namespace tanktread::coupling
