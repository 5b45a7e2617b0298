#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tanktread {

/// A mistake of the user's: one sentence that says what, where, what is allowed, what was given. Exit code 2.
struct UserError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Several of them, each with its sentence.
struct UserErrors : UserError {
  explicit UserErrors(std::vector<std::string> sentences) : UserError(joined(sentences)), all(std::move(sentences)) {}
  std::vector<std::string> all;

 private:
  static std::string joined(const std::vector<std::string>& sentences) {
    std::string text;
    for (const std::string& sentence : sentences) text += (text.empty() ? "" : " ") + sentence;
    return text;
  }
};

/// Throws UserError or UserErrors unless there are none.
inline void require_none(std::vector<std::string> mistakes) {
  if (mistakes.size() == 1) throw UserError(mistakes.front());
  if (!mistakes.empty()) throw UserErrors(std::move(mistakes));
}

/// A run that went wrong (not a number, folded element, step too small, solver not converged). Exit code 3, after a checkpoint.
struct RunFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace tanktread
