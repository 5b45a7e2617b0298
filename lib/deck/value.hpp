#pragma once
// From an entry of a parameter list to a value of the type that was asked for.

#include <optional>
#include <string>
#include <vector>

#include "deck/forward.hpp"

namespace tanktread::deck {

/// The entry as the type, or nothing if it is of another one. Whole numbers are numbers, too.
std::optional<double> as_number(const Teuchos::ParameterEntry& entry);
std::optional<bool> as_truth(const Teuchos::ParameterEntry& entry);
std::optional<std::string> as_text(const Teuchos::ParameterEntry& entry);
std::vector<std::string> as_texts(const Teuchos::ParameterEntry& entry);  ///< one or a row of them; of anything else none
std::optional<std::vector<double>> as_numbers(const Teuchos::ParameterEntry& entry);  ///< a row, or rows of a table one after the other

/// Whether both stand for the same value; whole numbers are numbers, too.
bool same_value(const Teuchos::ParameterEntry& a, const Teuchos::ParameterEntry& b);

/// What was given, for a message: `-1`, `"one"` (text), `[1, 2]`, a list of keys.
std::string description(const Teuchos::ParameterEntry& entry);

/// A list of another library as YAML, and the merge of two lists, key by key: `over` wins.
std::string yaml_text(const Teuchos::ParameterList& list, int depth);
void overlay(Teuchos::ParameterList& base, const Teuchos::ParameterList& over);

/// Holds a list that is handed to another library against what that library says it takes (its getValidParameters()). Throws UserError at
/// the first parameter that it does not know, with a guess of what was meant, or that is of another type (number, whole number, truth, text).
void check_foreign(const std::string& path, const Teuchos::ParameterList& given, const Teuchos::ParameterList& valid);

}  // namespace tanktread::deck
