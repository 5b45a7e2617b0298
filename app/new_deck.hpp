#pragma once
// Decks to start from.

#include <string>
#include <vector>

namespace tanktread {

/// The names of the kinds of scenes that there is a deck for.
std::vector<std::string> kinds_of_decks();

/// A deck of this kind as YAML, each key under its meaning.
std::string new_deck(const std::string& kind);

}  // namespace tanktread
