#pragma once
// What people call keys that have another name here, and what they look for and this program does not have.

#include <string>

namespace tanktread::deck {

/// The path of the key that is probably meant by a name which the deck does not know, `Time/final time` for `tend`; empty: none.
std::string synonym(const std::string& name);

/// Why the key at this path does not exist: a sentence, without its point, on what this program does not compute; empty: none.
std::string missing_feature(const std::string& path);

}  // namespace tanktread::deck
