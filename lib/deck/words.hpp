#pragma once
// Conversion of values and lists of names to text, for messages, decks and the manual.
// synonyms.cpp contains synonym and missing_feature, words.cpp the other functions.

#include <string>
#include <vector>

namespace tanktread::deck {

/// Returns the shortest decimal text that reads back to the same double, at most 17 digits: `0.1`, `12`, `1e-05`.
std::string number_text(double value);

/// Returns `number_text` with a decimal point, so that every YAML reader reads a real number: `12.0`, `1.0e-05`; `.nan`, `.inf`, `-.inf`.
std::string real_text(double value);

/// Returns the text in double quotes. Escapes `"`, `\` and control characters.
std::string in_quotes(const std::string& text);

/// Returns whether the text certainly needs no quotes in YAML: it begins with a letter, is no truth value and no special number (nan, inf), and has
/// no punctuation except - and _.
bool is_plain(const std::string& text);

/// Returns the text with ASCII letters in lower case.
std::string lower_case(std::string text);

/// Returns the text if it has at most `most` bytes, otherwise its beginning and `...`, together at most `most` bytes.
std::string shortened(const std::string& text, std::size_t most);

/// Returns `a, b or c`.
std::string alternatives(const std::vector<std::string>& words);
/// Returns the words separated by commas, with `last_link` before the last word.
std::string joined(const std::vector<std::string>& words, const std::string& last_link);

/// Returns the candidate with the smallest edit distance from `given` (insert, delete, replace, swap of neighbours), without regard to case. Returns
/// an empty text if this distance is larger than both 1 and a third of the length of `given`.
std::string guess(const std::string& given, const std::vector<std::string>& candidates);

/// Returns the path of the key that a user probably means by an unknown name, for example `Time/final time` for `tend`; empty if no key is similar.
std::string synonym(const std::string& name);

/// Returns the reason why there is no key at this path: a sentence, without full stop, about a feature that the program does not have. Returns an
/// empty text if no reason is known.
std::string missing_feature(const std::string& path);

}  // namespace tanktread::deck
