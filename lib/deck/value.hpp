#pragma once
// Conversion of parameter list entries to values, and operations on parameter lists.

#include <optional>
#include <string>
#include <vector>

#include "deck/forward.hpp"

namespace tanktread::deck {

/// Each of these functions returns the value of the entry, or nothing if the entry has another type. A whole number also counts as a number.
std::optional<double> as_number(const Teuchos::ParameterEntry& entry);
std::optional<bool> as_truth(const Teuchos::ParameterEntry& entry);
std::optional<std::string> as_text(const Teuchos::ParameterEntry& entry);
std::vector<std::string> as_texts(const Teuchos::ParameterEntry& entry);  ///< one text, or a sequence of texts; empty for any other entry
std::optional<std::vector<double>> as_numbers(const Teuchos::ParameterEntry& entry);  ///< numbers of a sequence, or of a matrix row by row

/// Returns whether both entries have the same value. A whole number equals the same number of type double.
bool same_value(const Teuchos::ParameterEntry& a, const Teuchos::ParameterEntry& b);

/// Returns the value of an entry as text for a message: `-1`, `"one"` (text), `[1, 2]`, a section of keys.
std::string description(const Teuchos::ParameterEntry& entry);

/// Returns a parameter list as YAML, indented by `depth` steps.
std::string yaml_text(const Teuchos::ParameterList& list, int depth);

/// Merges `over` into `base`, key by key. Values of `over` replace values of `base`.
void overlay(Teuchos::ParameterList& base, const Teuchos::ParameterList& over);

/// Checks a section for another library against the parameters that this library accepts (its getValidParameters()). Throws UserError at the first
/// parameter that is unknown (the message suggests the closest name) or has another type (number, whole number, truth value, text).
void check_foreign(const std::string& path, const Teuchos::ParameterList& given, const Teuchos::ParameterList& valid);

}  // namespace tanktread::deck
