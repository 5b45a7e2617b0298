#pragma once

#include <stdexcept>

namespace tanktread {

/// A mistake of the user's: one sentence that says what, where, what is allowed, what was given. Exit code 2.
struct UserError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A run that went wrong (not a number, folded element, step too small, solver not converged). Exit code 3, after a checkpoint.
struct RunFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace tanktread
