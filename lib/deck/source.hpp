#pragma once
// Text of a deck to parameter lists, every mistake one sentence with its line.

#include <memory>
#include <string>

namespace Teuchos {
class ParameterList;
}

namespace tanktread::deck {

/// The name of the root list of every deck.
inline constexpr const char* root_name = "Tanktread";

/// The text of a file. Throws UserError if it is missing, a directory, unreadable, or far too long for a deck.
std::string file_text(const std::string& file);

/// The root list of a deck in YAML; `origin` names it in messages.
std::shared_ptr<Teuchos::ParameterList> yaml_list(const std::string& text, const std::string& origin);

/// The same from XML, as Teuchos writes it.
std::shared_ptr<Teuchos::ParameterList> xml_list(const std::string& text, const std::string& origin);

/// The root list that `Section/key=value` means, the value read as YAML.
std::shared_ptr<Teuchos::ParameterList> setting_list(const std::string& setting);

}  // namespace tanktread::deck
