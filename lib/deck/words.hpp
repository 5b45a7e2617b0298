#pragma once
// Values and lists of names as text, for messages, decks and the manual.

#include <string>
#include <vector>

namespace tanktread::deck {

/// The shortest decimal text that reads back to the same double, at most 17 digits: `0.1`, `12`, `1e-05`.
std::string number_text(double value);

/// The same with a point in it, which every YAML reader takes for a real number: `12.0`, `1.0e-05`; `.nan`, `.inf`, `-.inf`.
std::string real_text(double value);

/// Text in double quotes, with `"`, `\` and characters that no line of text holds escaped.
std::string in_quotes(const std::string& text);

/// Whether YAML reads the bare word as this very text (no number, no truth value, no punctuation).
bool is_plain(const std::string& text);

/// Letters of ASCII.
std::string lower_case(std::string text);

/// The text itself, or its beginning and `...`, at most `most` bytes together.
std::string shortened(const std::string& text, std::size_t most);

/// `a, b or c`, or with another last link.
std::string alternatives(const std::vector<std::string>& words);
std::string joined(const std::vector<std::string>& words, const std::string& last_link);

/// The candidate that was most probably meant, or nothing: the smallest edit distance (insert, delete, replace, swap of neighbours),
/// no more than a third of the length, upper and lower case alike.
std::string guess(const std::string& given, const std::vector<std::string>& candidates);

/// The path of the key that is probably meant by a name which the deck does not know, `Time/final time` for `tend`; empty: none.
std::string synonym(const std::string& name);

/// Why the key at this path does not exist: a sentence, without its point, on what this program does not compute; empty: none.
std::string missing_feature(const std::string& path);

}  // namespace tanktread::deck
