#pragma once
// Text of a deck to parameter lists, every mistake one sentence.

#include <memory>
#include <string>

#include "deck/forward.hpp"

namespace tanktread::deck {

/// The name of the root list of every deck.
inline constexpr const char* root_name = "Tanktread";

/// The root list of the deck in a file: YAML, or XML by extension. Throws UserError also where the file is none or longer than 1 MB.
std::shared_ptr<Teuchos::ParameterList> file_list(const std::string& file);

/// The root list of a deck in XML, as Teuchos writes it; `origin` names it in messages.
std::shared_ptr<Teuchos::ParameterList> xml_list(const std::string& text, const std::string& origin);

/// The list named `Tanktread` of all that a deck holds. Throws UserError where it is missing or not alone.
std::shared_ptr<Teuchos::ParameterList> root_list(const Teuchos::ParameterList& whole, const std::string& origin);

}  // namespace tanktread::deck
