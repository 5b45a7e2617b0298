#pragma once
// What Teuchos' YAML reader cannot: it drops lines with a stray indentation without a word, stops at bytes that are not ASCII even in
// comments, takes a # in quotes for a comment, and reports duplicate keys without their lines. So the lines of a deck are looked at first.

#include <string>
#include <vector>

namespace tanktread::deck {

/// The lines of a YAML text without comments, as many as before, with every byte that the reader cannot take written as `~` and two
/// hexadecimal digits (and `~` itself so). Throws UserError on tabs as indentation, stray indentation, duplicate keys, and control characters.
std::vector<std::string> clean_lines(const std::string& text, const std::string& origin);

/// The text that was meant by one from `clean_lines`.
std::string decoded(const std::string& text);

/// The keys of the outermost level.
std::vector<std::string> outermost_keys(const std::vector<std::string>& lines);

}  // namespace tanktread::deck
