#pragma once
// Message with which a call is refused.

#include <string>

#include "base/errors.hpp"

namespace tanktread {

/// Returns the message of the UserError that the call throws; empty if it throws none.
template <class Call>
std::string refusal_of(Call call) {
  try {
    call();
  } catch (const UserError& error) {
    return error.what();
  }
  return {};
}

}  // namespace tanktread
