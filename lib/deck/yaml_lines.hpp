#pragma once
// What Teuchos' YAML reader leaves unsaid: it drops lines with a stray indentation without a word, stops at bytes that are not ASCII even in
// comments, and reports duplicate keys without their lines. So the lines of a deck are looked at before it reads them.

#include <string>
#include <vector>

namespace tanktread::deck {

/// The lines of a YAML text without comments (as many lines as before). Throws UserError on tabs as indentation, stray indentation,
/// duplicate keys, bytes that are no text, and non-ASCII characters outside of comments.
std::vector<std::string> clean_lines(const std::string& text, const std::string& origin);

/// The keys of the outermost level.
std::vector<std::string> outermost_keys(const std::vector<std::string>& lines);

}  // namespace tanktread::deck
