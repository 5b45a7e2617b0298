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

/// The root list of a deck in YAML 1.2, in which `origin` names the deck. A plain word is true or false (also yes, no), a whole number, a number, or
/// text; brackets hold a row of one of these, or rows of equal length. Throws UserError with the line for what is not YAML, a key given twice,
/// lists nested deeper than 20, and for what no deck holds.
std::shared_ptr<Teuchos::ParameterList> yaml_list(const std::string& text, const std::string& origin);

/// The same for `Section/key=value`, the value read as YAML.
std::shared_ptr<Teuchos::ParameterList> setting_list(const std::string& setting);

}  // namespace tanktread::deck
