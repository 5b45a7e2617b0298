#pragma once

#include <string>
#include <vector>

namespace tanktread {

/// Of the directory of a run's results: `<deck>_<overlay>_<key>=<value>`, of files the name without its ending, of a key its last part, with `_` for
/// all but letters, digits and `.-=`. A name above 100 characters is cut, and ends with a checksum of what it stands for.
std::string default_name(const std::vector<std::string>& decks, const std::vector<std::string>& settings);

}  // namespace tanktread
