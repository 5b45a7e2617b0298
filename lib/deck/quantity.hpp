#pragma once
// Spellings of numbers and units in decks.

#include <optional>
#include <string>

namespace tanktread::deck {

/// A number with the text of its unit in a notation of UDUNITS; the text is empty if there is no unit.
struct Quantity {
  double number;
  std::string unit;
};

/// Returns the number at the beginning of a text and the unit after it; nothing if the text does not begin with a number. Accepts what people write:
/// `5.3uN/m`, `1.2 x 10^-3 Pa s`, `−5 µm`, `100 /s`, `5 µm s⁻¹`, `35 mPas`, `3 mPa⋅s`, `1 um per second`, `0.3 N m**-1`.
std::optional<Quantity> quantity(const std::string& text);

/// Returns whether a unit is a product or quotient of words with whole exponents: `mN m^-1`, `kg/(m s)`. UDUNITS accepts more, such as numbers
/// within a unit and shifted units, with which a text like `1 500 um` or `1 um from 3` would have a meaning that nobody intends.
bool is_product_of_words(const std::string& unit);

/// Returns the end of a sentence about a refused number, with the spelling of a text that works: `; write 5.3 uN/m` for `5,3 uN/m`. Returns an empty
/// text if the text is not a number in another spelling.
std::string working_spelling(const std::string& text);

}  // namespace tanktread::deck
