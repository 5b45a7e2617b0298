#pragma once
// Readers that convert the text of a deck to parameter lists. Each error message is one sentence.
// yaml.cpp contains yaml_list and setting_list, source.cpp the other functions.

#include <memory>
#include <string>

#include "deck/forward.hpp"

namespace tanktread::deck {

/// Name of the root section of every deck.
inline constexpr const char* root_name = "Tanktread";

/// Returns the root section of the deck in a file (XML if its name ends with .xml, otherwise YAML). Throws UserError if the file cannot be read, is
/// longer than 1 MB, or holds no deck.
std::shared_ptr<Teuchos::ParameterList> file_list(const std::string& file);

/// Returns the root section of a deck in the XML format of Teuchos. `origin` is the name of the deck in messages.
std::shared_ptr<Teuchos::ParameterList> xml_list(const std::string& text, const std::string& origin);

/// Returns the section `Tanktread` inside `whole`, which was read from a deck. Throws UserError if it is missing or if `whole` has other sections.
/// `origin` is the name of the deck in messages.
std::shared_ptr<Teuchos::ParameterList> root_list(const Teuchos::ParameterList& whole, const std::string& origin);

/// Returns the root section of a deck in YAML 1.2. `origin` is the name of the deck in messages. A scalar without quotes is true or false (also yes,
/// no), a whole number, a number, or text. Brackets hold a sequence of scalars, or sequences of equal length (the rows of a matrix). Throws
/// UserError, with the line, if the text is not valid YAML, a key is given twice, sections are nested deeper than 20, or a value has a type that no
/// key of a deck has.
std::shared_ptr<Teuchos::ParameterList> yaml_list(const std::string& text, const std::string& origin);

/// Returns the root section of a deck that contains only the key of `setting`, which is `Section/key=value`. The value is read as YAML.
std::shared_ptr<Teuchos::ParameterList> setting_list(const std::string& setting);

}  // namespace tanktread::deck
