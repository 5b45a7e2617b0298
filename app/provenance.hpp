#pragma once

#include <map>
#include <string>

namespace tanktread {

/// What made a result: version, git_commit, compiler. (`/provenance` of run.h5 adds the number of ranks.)
std::map<std::string, std::string> provenance();

}  // namespace tanktread
