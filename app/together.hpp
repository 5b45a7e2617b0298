#pragma once
// What some ranks do and all of them answer for.

#include <exception>
#include <string>

#include "base/errors.hpp"
#include "coupling/ranks.hpp"

namespace tanktread {

/// Ranks act; if one fails, every rank throws: UserError for a mistake of the user's, RunFailure for anything else. Collective.
template <class Act>
void together(const coupling::Ranks& ranks, bool acts, const Act& action) {
  std::string error;
  bool mistake = false;
  if (acts) {
    try {
      action();
    } catch (const std::exception& exception) {
      error = exception.what();
      mistake = dynamic_cast<const UserError*>(&exception) != nullptr;
    }
  }
  if (!ranks.any(!error.empty())) return;
  if (error.empty()) error = "another rank could not do its part";
  if (ranks.any(mistake)) throw UserError(error);
  throw RunFailure(error);
}

}  // namespace tanktread
