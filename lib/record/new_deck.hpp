#pragma once
// Example decks that `tanktread --new` prints.

#include <string>
#include <vector>

namespace tanktread {

/// Returns the names of the example decks.
std::vector<std::string> kinds_of_decks();

/// Returns the text of the example deck `kind`, with a comment for each key.
std::string new_deck(const std::string& kind);

}  // namespace tanktread
