#pragma once

#include <memory>
#include <string>

#include "deck/forward.hpp"

namespace tanktread::deck {

/// The root list of a deck in YAML 1.2, in which `origin` names the deck. A plain word is true or false (also yes, no), a whole number, a number, or
/// text; brackets hold a row of one of these, or rows of equal length. Throws UserError with the line for what is not YAML, a key given twice,
/// lists nested deeper than 20, and for what no deck holds.
std::shared_ptr<Teuchos::ParameterList> yaml_list(const std::string& text, const std::string& origin);

/// The same for `Section/key=value`, the value read as YAML.
std::shared_ptr<Teuchos::ParameterList> setting_list(const std::string& setting);

}  // namespace tanktread::deck
