#pragma once

#include <string>

#include "deck/forward.hpp"

namespace tanktread::deck {

/// Holds a list that is handed to another library against what that library says it takes (its getValidParameters()). Throws UserError at
/// the first parameter that it does not know, with a guess of what was meant, or that is of another type (number, whole number, truth, text).
void check_foreign(const std::string& path, const Teuchos::ParameterList& given, const Teuchos::ParameterList& valid);

}  // namespace tanktread::deck
