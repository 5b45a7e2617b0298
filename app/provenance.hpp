#pragma once

#include <map>
#include <string>

namespace tanktread {

/// Returns the version, git_commit and compiler of the program. (`/provenance` of run.h5 also contains the number of ranks.)
std::map<std::string, std::string> provenance();

}  // namespace tanktread
